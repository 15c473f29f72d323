// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <assimp/mesh.h>
#include <glm/vec3.hpp>

namespace furrow::authoring {

// A blend shape of a mesh with its in-betweens. assimp 5.2 lists an FBX channel with in-betweens as
// several shapes of one name, one after the other, and loses their weights.
struct ShapeGroup {
  std::string name;  // as in the file; may be empty
  // Shapes with the mesh's number of vertices, those that move least first. The last is the whole
  // shape. May be empty.
  std::vector<const aiAnimMesh*> shapes;
};

// The groups of a mesh in the file's order. Their indices are the values of an animation's keys.
[[nodiscard]] std::vector<ShapeGroup> GroupShapes(const aiMesh& mesh);

// A morph target to write.
struct NamedDeltas {
  std::string name;               // ASCII
  std::vector<glm::vec3> deltas;  // one per vertex, in the mesh's space
};

// The morph targets of a group: the whole shape, and a corrective for each in-between, called
// "jawOpen33" and "jawOpen67" (docs/SHAPES.md). In-betweens are spread evenly over the shape's
// weight, because their own weights are lost: with their correctives, the shape passes through each
// of them. In-betweens of a shape that cannot have correctives (its name ends with a digit, or
// there are more than 9) are left out. Appends a sentence to `remarks` if the group has
// in-betweens.
[[nodiscard]] std::vector<NamedDeltas> TargetsOf(const ShapeGroup& group, const aiMesh& mesh,
                                                 std::vector<std::string>* remarks);

}  // namespace furrow::authoring
