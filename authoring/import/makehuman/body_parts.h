// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/mesh_builder.h"
#include "authoring/import/makehuman/mhclo.h"
#include "authoring/import/makehuman/obj.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// MakeHuman's base mesh, fitted and skinned. The parts of the character are cut from it.
struct BaseMesh {
  ObjMesh obj;
  std::vector<glm::vec3> positions;  // metres, feet on y = 0; all vertices, including helpers
  SkinWeights skin;
};

// The faces of a group of `obj`; empty if there is no such group.
[[nodiscard]] std::vector<std::uint32_t> FacesOf(const ObjMesh& obj, std::string_view group);

// The skin: the group "body" without faces that are fully hidden. `deleted`: by base vertex,
// whether clothes hide it (may be empty). UV islands are rearranged so that the face, which needs
// the most detail, fills three quarters of the picture.
[[nodiscard]] character::Mesh BuildSkin(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                                        const std::vector<bool>& deleted, int material,
                                        int* hidden_faces);

// A group of helpers without changes (the tongue).
[[nodiscard]] character::Mesh BuildHelper(const BaseMesh& base, std::string_view group,
                                          int material);

// A row of teeth (authoring/paint/teeth.h) in place of the group's coarse box, with its skin
// weights.
[[nodiscard]] character::Mesh BuildTeeth(const BaseMesh& base, std::string_view group, bool upper,
                                         int material);

// A smooth eyeball with a slight cornea in place of the group's coarse ball. It follows `joint` and
// looks along the unit vector `forward`. UVs fit PaintEye().
[[nodiscard]] character::Mesh BuildEye(const BaseMesh& base, std::string_view group, int joint,
                                       const glm::vec3& forward, int material);

}  // namespace furrow::authoring
