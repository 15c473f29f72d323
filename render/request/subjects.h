// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "render/request/frame_request.h"

namespace furrow::render {

// A subject of a request, and its name for error messages.
struct NamedSubject {
  const PosedSubject* subject = nullptr;
  std::string field;  // prefix of its fields in error messages: "", "others[3]."
};

// All subjects of a request: the request itself, then `others`. The pointers refer to `request`.
[[nodiscard]] std::vector<NamedSubject> SubjectsOf(const FrameRequest& request);

}  // namespace furrow::render
