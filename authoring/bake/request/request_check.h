// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "authoring/bake/request/bake_request.h"
#include "character/character.h"

namespace furrow::authoring {

// Checks the arguments of Bake() before any work: names, counts, ranges and finite numbers. Errors:
// kInvalidArgument, kNonFinite; `where` names the pose, the stroke or the group of options.
[[nodiscard]] Status CheckBake(const character::Character& character,
                               std::span<const BakePose> poses, std::span<const BakeStroke> strokes,
                               const BakeOptions& options);

// Checks the numbers of a stroke, from a file or from code, against the ranges that BakeStroke
// states. Errors: kInvalidArgument, kNonFinite; `where` is a field below `at`: "strokes[2].taper".
[[nodiscard]] Status CheckStrokeNumbers(const BakeStroke& stroke, const std::string& at);

}  // namespace furrow::authoring
