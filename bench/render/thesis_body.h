// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/render/moving_scene.h"
#include "character/character.h"

// The body of the thesis (chapter 5), generated with the triangle count that it states.
namespace furrow::bench {

inline constexpr int kBodyTriangles = 8290;

// Makes a clothed body of kBodyTriangles: a trunk, two arms, two legs and a head. It always has 156
// joints in chains. The rig has `hinges` hinge drivers and `balls` ball drivers (at most 150 in
// all), each with a region that is masked by skinning and feeds the map folds. Without drivers: no
// map.
[[nodiscard]] character::Character MakeBody(int hinges, int balls);

inline constexpr Extent kBodyExtent = {0.55f, 0.95f};

}  // namespace furrow::bench
