// SPDX-License-Identifier: Apache-2.0
#include "report/words.h"

namespace furrow::report {

std::string Counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace furrow::report
