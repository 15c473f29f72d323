// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"

namespace furrow::authoring {

inline constexpr int kPaintedMaskSide = 1024;  // texels of a mask that an export paints

// Joints of the character whose skin weights make up the mask of a region (Mask::Kind::kSkinning):
// those that the drivers of its feeds move. Indices, ascending.
[[nodiscard]] std::vector<int> MaskJoints(const character::Character& character,
                                          const wrinkle::Region& region);

// True if a picture can hold the mask of a region that no picture of the rig paints.
//
// - Kind::kSkinning: some joint of MaskJoints() exists.
// - Kind::kSliding: the mask stays in place, because all feeds read nothing but one side of the
//   mask's hinge or twist. The mask of a ball follows the joint, so no picture can hold it.
[[nodiscard]] bool CanPaintMask(const character::Character& character,
                                const wrinkle::Region& region);

// Paints the mask of a region as one channel of 8 bits, over the UVs of all materials that its maps
// are drawn on. Precondition: CanPaintMask().
//
// - By skin weights: clamp(sum of lambda(skin weight) over MaskJoints(), 0, 1). The renderer
//   multiplies each joint by its own driver's value before it clamps. Both masks are equal if one
//   driver value raises the region, as at a knee or an elbow.
// - Sliding: wrinkle::SlidingMaskAt(), as in the renderer.
// - Values are those of the vertices, interpolated. Texels beyond the edge of the surface get the
//   value of its nearest point, as far as filtering reaches. Materials whose UVs overlap themselves
//   too much are left out.
// - A picture cannot tell apart points that share a texel, such as two sleeves with one texture.
//   The largest of their masks counts, and `is_shared` says so.
struct PaintedMask {
  character::Picture picture;
  bool is_shared = false;
};
[[nodiscard]] PaintedMask PaintMask(const character::Character& character,
                                    const wrinkle::Region& region, int side);

}  // namespace furrow::authoring
