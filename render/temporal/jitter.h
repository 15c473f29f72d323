// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace furrow::render {

// By how much picture number `number` of a stream moves the scene, in pixels that are drawn,
// [-0.5, 0.5). Consecutive pictures sample different points of each pixel, evenly (Halton sequence
// of the bases 2 and 3). `scale`: drawn pixels per pixel of the picture, (0, 1]. The smaller it is,
// the more pictures it takes until the sequence begins again, so that each pixel of the picture
// gets about eight samples.
[[nodiscard]] glm::vec2 Jitter(int number, float scale);

}  // namespace furrow::render
