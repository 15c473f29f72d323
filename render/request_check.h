// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/renderer.h"

namespace furrow::render {

inline constexpr int kMinSize = 16;  // pixels
inline constexpr int kMaxSize = 4096;

// Whether a request can be drawn for a character of `num_joints`. kInvalidArgument (`where` is the
// field: "settings.exposure", "others[3].model"), kNonFinite or kLimit (more than kMaxSubjects).
[[nodiscard]] Status CheckRequest(const FrameRequest& request, int num_joints);

}  // namespace furrow::render
