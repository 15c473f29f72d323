// SPDX-License-Identifier: Apache-2.0
#include "rig/json/json_object.h"

#include <array>
#include <charconv>

namespace furrow::rig {
namespace {

// A nested value moves right by two columns; its first line follows the field's name.
std::string Indented(std::string_view text) {
  std::string indented;
  for (const char c : text) {
    indented += c;
    if (c == '\n') indented += "  ";
  }
  return indented;
}

}  // namespace

// Bytes above 0x7f pass unchanged: JSON is UTF-8.
std::string Quote(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (byte < 0x20) {
      quoted += std::string("\\u00") + kHex[byte >> 4] + kHex[byte & 15];
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

// The shortest text that reads back as the same float, whatever the locale.
std::string Number(float value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string Numbers(const glm::vec3& v) {
  return "[" + Number(v.x) + ", " + Number(v.y) + ", " + Number(v.z) + "]";
}

std::string Numbers(const glm::quat& q) {
  return "[" + Number(q.x) + ", " + Number(q.y) + ", " + Number(q.z) + ", " + Number(q.w) + "]";
}

std::string Bracketed(char open, const std::vector<std::string>& items, char close) {
  constexpr std::size_t kLineWidth = 90;
  std::size_t width = 0;
  bool many_lines = false;
  for (const std::string& item : items) {
    width += item.size() + 2;
    many_lines |= item.find('\n') != std::string::npos;
  }
  std::string text(1, open);
  const bool one_line = !many_lines && width < kLineWidth;
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += i == 0 ? "" : ",";
    text += one_line ? (i == 0 ? "" : " ") : "\n  ";
    text += Indented(items[i]);
  }
  return text + (one_line ? "" : "\n") + close;
}

}  // namespace furrow::rig
