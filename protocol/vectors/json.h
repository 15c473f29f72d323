// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cinttypes>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/messages/messages.h"

// Messages as JSON text, in the same form as tests/conformance/decode.py prints them.
namespace furrow::protocol::vectors {

using Fields = std::vector<std::pair<std::string, std::string>>;  // name, JSON

inline std::string Json(bool value) { return value ? "true" : "false"; }
inline std::string Json(int value) { return std::to_string(value); }
inline std::string Json(std::int64_t value) { return std::to_string(value); }

// Nine digits reproduce every binary32 exactly.
inline std::string Json(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

// A string such as "0x00000000000000ff", because many JSON readers keep only 53 bits of a number.
inline std::string JsonHex(std::uint64_t value) {
  char text[32];
  std::snprintf(text, sizeof text, "\"0x%016" PRIx64 "\"", value);
  return text;
}

// Plain text (text.h) has no control characters, so only two characters need an escape.
inline std::string Json(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}
inline std::string Json(const std::string& text) { return Json(std::string_view(text)); }

inline std::string Json(const Vec3& v) {
  return "[" + Json(v.x) + ", " + Json(v.y) + ", " + Json(v.z) + "]";
}
inline std::string Json(const Quat& q) {
  return "[" + Json(q.x) + ", " + Json(q.y) + ", " + Json(q.z) + ", " + Json(q.w) + "]";
}

template <class T>
std::string Json(const std::vector<T>& values) {
  std::string out = "[";
  for (const T& value : values) out += (out.size() > 1 ? ", " : "") + Json(value);
  return out + "]";
}

inline std::string Json(const Fields& fields, const std::string& indent = "") {
  std::string out = "{";
  for (const auto& [name, value] : fields) {
    out += (out.size() > 1 ? ",\n" : "\n") + indent + "  " + Json(name) + ": " + value;
  }
  return out + "\n" + indent + "}";
}

}  // namespace furrow::protocol::vectors
