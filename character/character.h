// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/mesh/material_bind.h"
#include "character/mesh/mesh.h"
#include "character/pictures/picture.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/shapes/shape_rules.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// A character that can be drawn and wrinkled: the contents of a verified .glb file and a verified
// wrinkle rig. The rig is empty if the character has none.
struct Character {
  std::string name;
  wrinkle::Skeleton skeleton;
  // The roles that the package states for its joints, whatever their names: one per joint of the
  // skeleton. Empty: it states none, and skeleton maps or the hierarchy tell them.
  wrinkle::JointRoles roles;
  // Model space in the rest pose to joint space; one per joint of the skeleton.
  std::vector<glm::mat4> inverse_bind_matrices;
  std::vector<Mesh> meshes;
  // Names of the shapes that move the meshes or change materials, unique, at most kMaxShapes.
  // Targets of equal names on different meshes (head, teeth, lashes) are one shape.
  std::vector<std::string> shapes;
  std::vector<wrinkle::ShapeRule> shape_rules;  // at most one per shape
  std::vector<Material> materials;
  std::vector<MaterialBind> material_binds;  // at most one per shape and material
  std::vector<Picture> pictures;
  wrinkle::Rig rig;
  std::filesystem::path folder;  // the folder that is searched first for the rig's files
  // The rig's masks and wrinkle maps: (name in the rig, index into `pictures`).
  std::vector<std::pair<std::string, int>> rig_pictures;
  // Pictures that the rig names but that were not found. Regions and maps that need them are not
  // drawn; wrinkle weights are unaffected.
  std::vector<std::string> missing_rig_pictures;
  // Where the reader deviated from the glTF file: "nodes[3].matrix: the matrix has shear, ...".
  std::vector<std::string> warnings;

  // The index in `pictures` of a picture that the rig names; -1 if it is not in rig_pictures.
  [[nodiscard]] int FindRigPicture(std::string_view name) const;
};

}  // namespace furrow::character
