// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "bench/render/moving_scene.h"
#include "character/character.h"

// The head of the thesis (chapter 5), generated with the triangle count that it states.
namespace furrow::bench {

inline constexpr int kHeadTriangles = 3080;

// Makes a head of kHeadTriangles around the origin. It has eight regions, each with a facial joint,
// a pose driver and a channel of two mask textures. They feed the maps stretch and squash (512 x
// 512). The skin has a colour and a normal map of the same size.
[[nodiscard]] character::Character MakeHead();

// The positions of `heads` heads in a grid in the plane z = 0, and the area that they fill.
[[nodiscard]] std::vector<glm::mat4> HeadPlacements(int heads);
[[nodiscard]] Extent HeadsExtent(int heads);

}  // namespace furrow::bench
