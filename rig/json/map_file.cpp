// SPDX-License-Identifier: Apache-2.0
#include "rig/json/map_file.h"

namespace furrow::rig {

std::string WithSide(std::string text, const std::string& side) {
  for (std::size_t at = text.find('*'); at != std::string::npos;
       at = text.find('*', at + side.size())) {
    text.replace(at, 1, side);
  }
  return text;
}

}  // namespace furrow::rig
