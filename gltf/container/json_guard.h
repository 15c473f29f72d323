// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/status.h"

namespace furrow::gltf {

// Checks the nesting (kMaxJsonDepth) and the number of values (kMaxJsonValues) of a JSON text
// before a JSON library parses it. Such libraries recurse on nesting and allocate for each value.
//
// The scan does not check syntax. Brackets and commas inside strings do not count. Errors: kLimit.
[[nodiscard]] Status CheckJsonSize(std::string_view json);

}  // namespace furrow::gltf
