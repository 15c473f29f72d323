// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/bake.h"

// Surfaces with known strain, for tests that bake maps.
namespace furrow::authoring::toys {

// A point of a grid; u and v are in [0, 1] along the grid.
struct Point {
  glm::vec3 position{0.0f};
  glm::vec2 uv{0.0f};
  float weight_of_second = 0.0f;  // skin weight of joint 1; joint 0 has the remainder
};

// A mesh of columns x rows quads from a function of (u, v). Triangles are counter-clockwise as seen
// with u to the right and v up. Normals and tangents are computed.
[[nodiscard]] character::Mesh Grid(int columns, int rows,
                                   const std::function<Point(float, float)>& point);

// Appends a mesh to another mesh.
void Append(const character::Mesh& from, character::Mesh* to);

// A character with two joints, "a" and "b", one mesh of skin or cloth, a region "patch" without a
// mask picture, and one wrinkle map "folds" on that surface.
[[nodiscard]] character::Character Wearing(character::Mesh mesh, bool cloth = false);

// A sheet in the plane z = 0, `width` x `height` metres, with its lower left corner at the origin.
// Its UVs fill the picture.
[[nodiscard]] character::Mesh Sheet(float width, float height, int columns, int rows);

// A pose for the map "folds" that moves joint 0 by `first` and joint 1 by `second`.
[[nodiscard]] BakePose Pose(const glm::mat4& first, const glm::mat4& second);
[[nodiscard]] inline BakePose Pose(const glm::mat4& both) { return Pose(both, both); }
// Scales by 1 - `compression` along the direction at `degrees` from x in the plane z = 0.
[[nodiscard]] glm::mat4 Squeeze(float compression, float degrees);

// Options for exact results: no variation, no threshold, folds of 10 mm that take up the whole
// compression, 256 texels, one thread.
[[nodiscard]] BakeOptions Exact();

// Bakes the map "folds". On an error the test fails.
[[nodiscard]] BakedMap BakeFolds(const character::Character& character, std::vector<BakePose> poses,
                                 const BakeOptions& options, std::vector<BakeStroke> strokes = {});

// The index of the texel in column x and row y.
[[nodiscard]] inline std::size_t At(const BakedMap& map, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
         static_cast<std::size_t>(x);
}

}  // namespace furrow::authoring::toys
