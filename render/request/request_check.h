// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/status.h"
#include "render/request/frame_request.h"

namespace furrow::render {

// Checks everything in a request except its wrinkle values, for a character of `num_joints`
// and `num_shapes`. Errors: kInvalidArgument, kNonFinite, or kLimit (more than kMaxSubjects).
// `where` is the field: "settings.exposure", "others[3].model".
[[nodiscard]] Status CheckRequest(const FrameRequest& request, int num_joints,
                                  std::size_t num_shapes = 0);

}  // namespace furrow::render
