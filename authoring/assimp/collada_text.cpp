// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/collada_text.h"

#include <cstddef>

namespace furrow::authoring {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kNumberStarts = "0123456789+-.";

}  // namespace

std::string WithoutBlanksBeforeNumbers(std::string_view xml) {
  std::string text;
  text.reserve(xml.size());
  while (!xml.empty()) {
    // Up to the end of a tag, and the tag's '>'.
    const std::size_t end = xml.find('>');
    const std::size_t length = end == std::string_view::npos ? xml.size() : end + 1;
    text += xml.substr(0, length);
    xml.remove_prefix(length);
    const std::size_t start = xml.find_first_not_of(kBlanks);
    if (start == std::string_view::npos) continue;
    if (kNumberStarts.find(xml[start]) != std::string_view::npos) xml.remove_prefix(start);
  }
  return text;
}

}  // namespace furrow::authoring
