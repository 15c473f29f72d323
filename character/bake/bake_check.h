// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "character/bake/bake.h"

namespace furrow::character::bake {

// What Bake() refuses before it begins, by name: see there.
[[nodiscard]] Status CheckBake(const Character& character, std::span<const BakePose> poses,
                               std::span<const BakeStroke> strokes, const BakeOptions& options);

}  // namespace furrow::character::bake
