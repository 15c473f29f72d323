// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace furrow::render {

// A square of a level of a material's textures, and all that wrinkles can paint over it. Planes
// hold a number a texel, row after row; half floats where not said otherwise.
struct ComposeTile {
  static constexpr int kSide = 32;
  static constexpr std::size_t kTexels = std::size_t{kSide} * kSide;

  struct Map {
    std::vector<std::uint16_t> slopes;  // n.x / n.z, n.y / n.z, variance: three planes
    std::vector<std::uint16_t> looks;   // linear red, green, blue, and cavity: four; or empty
  };
  // What one channel lets through, of the mask textures or of the vertices' masks: bytes, 255 is
  // all.
  struct Mask {
    std::size_t channel = 0;  // in the list that ComposeInk::weights go by
    std::vector<std::uint8_t> values;
  };

  glm::ivec2 place{0};                // in tiles, from the texel (0, 0)
  std::vector<std::uint16_t> slopes;  // of the surface itself, as of a map
  std::vector<std::uint16_t> colour;  // its linear red, green and blue; empty: maps have no looks
  float hollow = 0.0f;  // green below which the colour is a hollow's: wrinkles make none of skin
  std::vector<Map> maps;
  std::vector<Mask> masks;    // those that let something through
  std::vector<Mask> skinned;  // of vertices: together they let through all at most
};

// How strongly everything is painted.
struct ComposeInk {
  std::vector<float> weights;     // channels x maps: wrinkle weights
  std::vector<float> amplitudes;  // of each map's slopes
  std::vector<float> scales;      // of each map's colours: what 1 stands for
  glm::vec2 looks{1.0f};          // strengths of colours and of cavities
};

// Paints the wrinkles of a tile: what shaders/wrinkles/wrinkles_frag.glsl does in a fragment, by
// partial derivatives, of as many texels at once as the processor has lanes.
//
//   w_i = sum over masks of weight * mask + min(sum over skinned of weight * mask, 1)
//   slope = base + sum a_i w_i slope_i,  variance = base + sum (a_i w_i)^2 variance_i
//   look = product of max(1 + strength w_i (scale_i look_i - 1), 0)
//   colour = base * look, but green >= min(base, hollow)
struct ComposeJob {
  const ComposeTile* tile = nullptr;
  const ComposeInk* ink = nullptr;
  // RGBA of the tile's texels, half floats: a slope and its squares with the variance in them
  // (WithMoments() of render/wrinkles/derivative_map.h); colour, and cavity.
  std::span<std::uint16_t> slopes;
  std::span<std::uint16_t> colours;         // empty where the tile has no colour
  std::size_t stride = ComposeTile::kSide;  // texels from one row to the next, at least a tile's

  // False: a list is not as long as the others ask for, or a mask's channel is not among the ink's.
  [[nodiscard]] bool Validate() const;
  // False: not valid; nothing was written.
  [[nodiscard]] bool Run() const;
};

}  // namespace furrow::render
