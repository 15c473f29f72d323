// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "authoring/bake/request/bake_request.h"
#include "character/character.h"

namespace furrow::authoring {

// Checks the arguments of Bake(). Errors: see there.
[[nodiscard]] Status CheckBake(const character::Character& character,
                               std::span<const BakePose> poses, std::span<const BakeStroke> strokes,
                               const BakeOptions& options);

// Checks the numbers of a stroke against the ranges in docs/BAKE.md, for strokes from files and
// from code. `where` of an error is a field below `at`: "strokes[2].taper".
[[nodiscard]] Status CheckStrokeNumbers(const BakeStroke& stroke, const std::string& at);

}  // namespace furrow::authoring
