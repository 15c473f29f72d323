// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "character/character.h"

// The thesis's subjects (chapter 5), made by code with the triangle counts it states.
namespace furrow::bench {

inline constexpr int kHeadTriangles = 3080;
inline constexpr int kBodyTriangles = 8290;

// A head of kHeadTriangles around the origin. Eight regions, each with a facial joint, a pose
// driver and a channel of two mask textures, feed the maps stretch and squash (512 x 512); skin has
// a colour and a normal map of the same size.
[[nodiscard]] character::Character MakeHead();

// Half the height and width of what is to be seen, metres.
struct Extent {
  float half_width = 0.0f;
  float half_height = 0.0f;
};

// Where `heads` heads stand in a grid in the plane z = 0, and what they fill.
[[nodiscard]] std::vector<glm::mat4> HeadPlacements(int heads);
[[nodiscard]] Extent HeadsExtent(int heads);

// A clothed body of kBodyTriangles: a trunk, two arms, two legs and a head, 156 joints in chains,
// whatever the rig, which has `hinges` hinge drivers and `balls` ball drivers (150 in all at most),
// each with a region masked by skinning, all feeding the map folds. Without drivers: no map.
[[nodiscard]] character::Character MakeBody(int hinges, int balls);

inline constexpr Extent kBodyExtent = {0.55f, 0.95f};

}  // namespace furrow::bench
