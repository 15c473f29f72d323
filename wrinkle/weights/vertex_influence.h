// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// lambda of thesis 4.2: the weight of a joint's influence at a vertex that it skins, in [0, 1].
//
// - kBinary: 1 if `skin_weight` > 0, as printed. A skin weight of 1e-6 gives a full wrinkle, so the
//   boundary of a joint's vertices shows as a seam.
// - kSmooth: smoothstep(0, smooth_width, skin_weight). `smooth_width` > 0.
// - kLinear: the skin weight itself (Dutreve 2009).
[[nodiscard]] float Lambda(LambdaMode mode, float skin_weight, float smooth_width);

// Thesis 4.2 at one vertex: clamp(sum of lambda(skin_weight) * influence, 0, 1) over its joints.
//
// The reference for the shaders of dynamic masks. Shaders clamp per fragment, after interpolating
// the vertices' sums. `influences` is the output of JointInfluenceJob (num_joints x num_masks,
// joint-major), and `mask` is one of its columns. `joints` and `skin_weights` belong to the vertex
// and have the same length.
[[nodiscard]] float VertexInfluence(std::span<const std::uint16_t> joints,
                                    std::span<const float> skin_weights,
                                    std::span<const float> influences, int num_masks, int mask,
                                    LambdaMode mode, float smooth_width);

}  // namespace furrow::wrinkle
