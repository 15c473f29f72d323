// SPDX-License-Identifier: Apache-2.0
#include "render/request/subjects.h"

namespace furrow::render {

std::vector<NamedSubject> SubjectsOf(const FrameRequest& request) {
  std::vector<NamedSubject> subjects{{&request, ""}};
  subjects.reserve(1 + request.others.size());
  for (std::size_t i = 0; i < request.others.size(); ++i) {
    subjects.push_back({&request.others[i], "others[" + std::to_string(i) + "]."});
  }
  return subjects;
}

}  // namespace furrow::render
