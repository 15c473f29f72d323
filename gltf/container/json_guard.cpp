// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/json_guard.h"

#include <cstddef>
#include <string>

#include "gltf/limits.h"

namespace furrow::gltf {

Status CheckJsonSize(std::string_view json) {
  // A scan without allocation, before any parser: a parser would exhaust the stack on deep nesting
  // and the memory on many values. Malformed text needs no care here, because the parser stops at
  // its first fault.
  int depth = 0;
  std::size_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      // An escaped quote does not end the string.
      if (c == '\\') ++i;
      in_string = c != '"';
      continue;
    }
    if (c == '"') in_string = true;
    // Every value except the first of its container follows a comma; the first follows a bracket.
    if (c == ',' || c == '{' || c == '[') ++values;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxJsonDepth) {
      return {StatusCode::kLimit,
              "the JSON is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels",
              "json"};
    }
    if (values > kMaxJsonValues) {
      return {StatusCode::kLimit,
              "the JSON has more than " + std::to_string(kMaxJsonValues) + " values", "json"};
    }
  }
  return {};
}

}  // namespace furrow::gltf
