// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/formats/mhclo.h"
#include "authoring/import/makehuman/formats/obj.h"
#include "authoring/import/makehuman/mesh_builder.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// MakeHuman's base mesh with skin weights. The parts of the character are cut from it. It contains
// the body and "helpers", invisible groups that clothes, eyes and teeth are fitted to.
struct BaseMesh {
  ObjMesh obj;
  std::vector<glm::vec3> positions;  // metres, feet on y = 0; one per position of `obj`
  SkinWeights skin;                  // one entry per position of `obj`
};

// Indices in `obj.faces` of the faces of a group; empty if there is no such group.
[[nodiscard]] std::vector<std::uint32_t> FacesOf(const ObjMesh& obj, std::string_view group);

// Builds the skin: the group "body" without faces that clothes hide. `deleted`: for each base
// vertex, whether clothes hide it; empty: none. `material`: index of the material. `hidden_faces`
// receives the number of omitted faces. UV islands are rearranged so that the face, which needs the
// most detail, fills three quarters of the picture. `uv_moves` (may be null) receives the moves of
// the islands, from left to right.
[[nodiscard]] character::Mesh BuildSkin(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                                        const std::vector<bool>& deleted, int material,
                                        int* hidden_faces, std::vector<UvMove>* uv_moves = nullptr);

// Builds a mesh from a group of helpers without changes (the tongue).
[[nodiscard]] character::Mesh BuildHelper(const BaseMesh& base, std::string_view group,
                                          int material);

// Builds a row of teeth in place of the group's coarse box, with the skin weights of the box.
// `upper`: the upper row, else the lower.
[[nodiscard]] character::Mesh BuildTeeth(const BaseMesh& base, std::string_view group, bool upper,
                                         int material);

// Builds a smooth eyeball with a slight cornea in place of the group's coarse ball. It follows the
// joint with index `joint` and looks along the unit vector `forward`. UVs fit PaintEye().
[[nodiscard]] character::Mesh BuildEye(const BaseMesh& base, std::string_view group, int joint,
                                       const glm::vec3& forward, int material);

}  // namespace furrow::authoring
