// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "base/status.h"

// How errors say where in a rig something is wrong: as a path of its fields, "drivers[3].hinge".
// Whoever read the rig from a file turns the path into a line (rig/rig_file.h).
namespace furrow::wrinkle {

// Entry `i` of the field `list`.
[[nodiscard]] inline std::string FieldAt(std::string_view list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

[[nodiscard]] inline Status InvalidField(std::string what, std::string where,
                                         std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), std::move(where), std::move(todo)};
}

}  // namespace furrow::wrinkle
