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

// MakeHuman's base mesh, ready to be cut into what is drawn.
struct BaseMesh {
  ObjMesh obj;
  std::vector<glm::vec3> positions;  // metres, feet on y = 0; all vertices, helpers too
  SkinWeights skin;
};

// The faces of a group of `obj`; empty when there is no such group.
[[nodiscard]] std::vector<std::uint32_t> FacesOf(const ObjMesh& obj, std::string_view group);

// The skin: the group "body" without the faces all of whose vertices `deleted` (by base vertex; may
// be empty) names. UV islands move so that the face's fills three quarters of the picture and the
// others share the rest: it is where the detail is needed.
[[nodiscard]] character::Mesh BuildSkin(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                                        const std::vector<bool>& deleted, int material,
                                        int* hidden_faces);

// One group of helpers as it stands (the tongue).
[[nodiscard]] character::Mesh BuildHelper(const BaseMesh& base, std::string_view group,
                                          int material);

// A row of teeth (authoring/paint/teeth.h) where the group's coarse box stands, held as that is.
[[nodiscard]] character::Mesh BuildTeeth(const BaseMesh& base, std::string_view group, bool upper,
                                         int material);

// A smooth ball with a slight cornea in place of the group's coarse one; it follows `joint` and
// looks along `forward` (unit). UVs as PaintEye() has them.
[[nodiscard]] character::Mesh BuildEye(const BaseMesh& base, std::string_view group, int joint,
                                       const glm::vec3& forward, int material);

}  // namespace furrow::authoring
