// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "base/status.h"

// Paths to the fields of a rig, as errors state them: "drivers[3].hinge". The reader of a rig file
// turns a path into a line number (rig/rig_file.h).
namespace furrow::wrinkle {

// The path of entry `i` of the list field `list`.
[[nodiscard]] inline std::string FieldAt(std::string_view list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

// kInvalidArgument for the field at the path `where`.
[[nodiscard]] inline Status InvalidField(std::string what, std::string where,
                                         std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), std::move(where), std::move(todo)};
}

}  // namespace furrow::wrinkle
