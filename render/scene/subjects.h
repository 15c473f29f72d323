// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"

namespace furrow::render {

struct NamedSubject {
  const PosedSubject* subject = nullptr;
  std::string field;  // in front of its fields in errors: "", "others[3]."
};

// All who are drawn: the request itself, then the others.
[[nodiscard]] std::vector<NamedSubject> SubjectsOf(const FrameRequest& request);

}  // namespace furrow::render
