// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"
#include "wrinkle/skeleton.h"

namespace furrow::character::generator {

// Shirt and trousers in one atlas, skinned.
[[nodiscard]] Mesh MakeClothes(const wrinkle::Skeleton& skeleton);
// A pair of shoes, skinned.
[[nodiscard]] Mesh MakeShoes(const wrinkle::Skeleton& skeleton);
// Appends both hands, skinned, to the head's skin: they lie in the free middle of its lowest band.
void AddHands(const wrinkle::Skeleton& skeleton, Mesh* skin);

}  // namespace furrow::character::generator
