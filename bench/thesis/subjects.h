// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

// The thesis's subjects (chapter 5), made by code with the triangle counts it states.
namespace furrow::bench {

inline constexpr int kHeadTriangles = 3080;
inline constexpr int kBodyTriangles = 8290;

// `heads` heads of kHeadTriangles in a grid in the plane z = 0, one mesh. Eight regions, each with
// a facial joint, a pose driver and a channel of two mask textures, feed the maps stretch and
// squash (512 x 512); skin has a colour and a normal map of the same size. All heads hang on one
// head's joints: they make the same face.
[[nodiscard]] character::Character MakeHeads(int heads);

// Half the height and width of what MakeHeads() fills, metres.
struct Extent {
  float half_width = 0.0f;
  float half_height = 0.0f;
};
[[nodiscard]] Extent HeadsExtent(int heads);

// A clothed body of kBodyTriangles: a trunk, two arms, two legs and a head, 150 joints in chains,
// whatever the rig, which has `hinges` hinge drivers and `balls` ball drivers (150 in all at most),
// each with a region masked by skinning, all feeding the map folds. Without drivers: no map.
[[nodiscard]] character::Character MakeBody(int hinges, int balls);

inline constexpr Extent kBodyExtent = {0.55f, 0.95f};

}  // namespace furrow::bench
