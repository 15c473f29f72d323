// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// lambda of thesis 4.2: how much a joint's influence counts at a vertex that it skins, in [0, 1].
//
// - kBinary: 1 where `skin_weight` > 0. As printed; a skin weight of 1e-6 gives a full wrinkle, so
//   the edge of a joint's vertices shows as a seam.
// - kSmooth: smoothstep(0, smooth_width, skin_weight). `smooth_width` > 0.
// - kLinear: the skin weight itself (Dutreve 2009).
[[nodiscard]] float Lambda(LambdaMode mode, float skin_weight, float smooth_width);

// Thesis 4.2 at one vertex: clamp(sum of lambda(skin_weight) * influence, 0, 1) over its joints.
//
// The reference for the shaders that draw dynamic masks; they clamp in the fragment, after a
// triangle has mixed its vertices' sums. `influences` as JointInfluenceJob leaves them (num_joints
// x num_masks, joint-major); `mask` is a column; `joints` and `skin_weights` are the vertex's,
// equally long.
[[nodiscard]] float VertexInfluence(std::span<const std::uint16_t> joints,
                                    std::span<const float> skin_weights,
                                    std::span<const float> influences, int num_masks, int mask,
                                    LambdaMode mode, float smooth_width);

}  // namespace furrow::wrinkle
