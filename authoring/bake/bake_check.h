// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "authoring/bake/bake.h"

namespace furrow::character::bake {

// What Bake() refuses before it begins, by name: see there.
[[nodiscard]] Status CheckBake(const Character& character, std::span<const BakePose> poses,
                               std::span<const BakeStroke> strokes, const BakeOptions& options);

// The numbers of a stroke, as docs/BAKE.md gives their ranges: of strokes from a file and of
// others. `where` of an error is the field below `at`: "strokes[2].taper".
[[nodiscard]] Status CheckStrokeNumbers(const BakeStroke& stroke, const std::string& at);

}  // namespace furrow::character::bake
