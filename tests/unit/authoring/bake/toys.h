// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/bake.h"

// Surfaces whose strain is known, to bake maps onto.
namespace furrow::authoring::toys {

// What a point of a toy's grid is: u, v in [0, 1] along the grid.
struct Point {
  glm::vec3 position{0.0f};
  glm::vec2 uv{0.0f};
  float weight_of_second = 0.0f;  // skin weight of joint 1; joint 0 has the rest
};

// A mesh of columns x rows quads from a function of (u, v), counter-clockwise from the side where
// u goes right and v goes up; normals and tangents are computed.
[[nodiscard]] character::Mesh Grid(int columns, int rows,
                                   const std::function<Point(float, float)>& point);

// Appends a mesh to another one.
void Append(const character::Mesh& from, character::Mesh* to);

// A character of two joints, "a" and "b", with one skin mesh, a region "patch" without a mask
// picture, and one wrinkle map "folds" on skin.
[[nodiscard]] character::Character Wearing(character::Mesh mesh);

// A sheet in the plane z = 0, `width` x `height` metres, lower left corner at the origin, which
// fills the picture.
[[nodiscard]] character::Mesh Sheet(float width, float height, int columns, int rows);

// A pose of the map "folds" that moves joint 0 and joint 1 by these matrices.
[[nodiscard]] BakePose Pose(const glm::mat4& first, const glm::mat4& second);
[[nodiscard]] inline BakePose Pose(const glm::mat4& both) { return Pose(both, both); }
// Squeezes to 1 - `compression` along the direction at `degrees` from x in the plane z = 0.
[[nodiscard]] glm::mat4 Squeeze(float compression, float degrees);

// Options for exact answers: no variation, no threshold, all of the compression taken up, 10 mm
// folds, 256 texels, one thread.
[[nodiscard]] BakeOptions Exact();

// Bakes the one map "folds"; fails the test where that fails.
[[nodiscard]] BakedMap BakeFolds(const character::Character& character, std::vector<BakePose> poses,
                                 const BakeOptions& options, std::vector<BakeStroke> strokes = {});

// A texel's index from the picture's rows and columns.
[[nodiscard]] inline std::size_t At(const BakedMap& map, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
         static_cast<std::size_t>(x);
}

}  // namespace furrow::authoring::toys
