// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"

namespace furrow::authoring {

inline constexpr int kSkinnedMaskSide = 1024;  // texels of a mask that an export paints

// Joints of the character whose skin weights make up the mask of a region (Mask::Kind::kSkinning):
// those that the drivers of its feeds move. Indices, ascending.
[[nodiscard]] std::vector<int> MaskJoints(const character::Character& character,
                                          const wrinkle::Region& region);

// Paints a region's mask by skin weights as one channel of 8 bits, over the UVs of all materials
// that its maps are drawn on: clamp(sum of lambda(skin weight) over MaskJoints(), 0, 1).
//
// - The renderer multiplies each joint by its own driver's value before it clamps. Both masks are
//   equal if one driver value raises the region, as at a knee or an elbow.
// - Texels beyond the edge of the surface get the value of its nearest point, as far as filtering
//   reaches. Materials whose UVs overlap themselves too much are left out.
// - A picture cannot tell apart points that share a texel, such as two sleeves with one texture.
//   The largest of their masks counts, and `is_shared` says so.
struct SkinnedMask {
  character::Picture picture;
  bool is_shared = false;
};
[[nodiscard]] SkinnedMask PaintSkinnedMask(const character::Character& character,
                                           const wrinkle::Region& region, int side);

}  // namespace furrow::authoring
