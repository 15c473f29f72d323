// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/surface/surface.h"

namespace furrow::authoring {

// A welded vertex of a surface in a pose.
struct PosedVertex {
  glm::vec3 position{0.0f};  // model space, metres
  glm::mat3 turn{1.0f};      // rotates directions at the vertex from the rest pose to the pose
};

// Skins a surface: one entry per welded vertex. `skin_matrices`: one per joint of the skeleton.
// `positions`: of the welded vertices before skinning, at rest or morphed.
//
// The motions of the joints are blended as dual quaternions (Kavan et al. 2007). The renderer
// blends linearly, but that flattens a bent limb, which would look like a lengthwise compression.
// If a skin matrix is not rigid, all are blended linearly.
[[nodiscard]] std::vector<PosedVertex> PoseSurface(const Surface& surface,
                                                   std::span<const glm::mat4> skin_matrices,
                                                   std::span<const glm::vec3> positions);

}  // namespace furrow::authoring
