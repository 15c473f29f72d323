// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace furrow::render {

// A square tile of one mip level of a material's textures, with everything that wrinkles can paint
// on it. A plane holds one number per texel, row by row; numbers are half floats unless stated
// otherwise.
struct ComposeTile {
  static constexpr int kSide = 32;
  static constexpr std::size_t kTexels = std::size_t{kSide} * kSide;

  struct Map {
    std::vector<std::uint16_t> slopes;  // three planes: n.x / n.z, n.y / n.z, variance
    std::vector<std::uint16_t> looks;   // four planes: linear red, green, blue, and cavity; or
                                        // empty
  };
  // One mask channel of the tile: bytes, 255 is fully masked in.
  struct Mask {
    std::size_t channel = 0;  // channel index of ComposeStrengths::weights
    std::vector<std::uint8_t> values;
  };

  glm::ivec2 place{0};                // position in tiles, from the texel (0, 0)
  std::vector<std::uint16_t> slopes;  // of the base surface, as in Map
  std::vector<std::uint16_t> colour;  // base colour, linear red, green, blue; empty: no map has
                                      // looks
  float cavity_albedo = 0.0f;  // base colours with a green below this are painted hollows; wrinkles
                               // must not create such colours
  std::vector<Map> maps;
  std::vector<Mask> masks;    // painted masks that are above 0 in the tile
  std::vector<Mask> skinned;  // masks by skin weight; their weighted sum is clamped to 1
};

// Strengths of everything that is painted on a tile.
struct ComposeStrengths {
  std::vector<float> weights;     // channels x maps: wrinkle weights
  std::vector<float> amplitudes;  // per map: factor of its slopes
  std::vector<float> scales;      // per map: factor of its colour
  glm::vec2 looks{1.0f};          // strengths of colours and of cavities
};

// Paints the wrinkles of a tile. It computes what shaders/wrinkles/wrinkles_frag.glsl computes per
// fragment with partial derivatives, for as many texels at once as the CPU has SIMD lanes.
//
//   w_i = sum over masks of weight * mask + min(sum over skinned of weight * mask, 1)
//   slope = base + sum a_i w_i slope_i,  variance = base + sum (a_i w_i)^2 variance_i
//   look = product of max(1 + strength w_i (scale_i look_i - 1), 0)
//   colour = base * look, but green >= min(base, cavity_albedo)
struct ComposeJob {
  const ComposeTile* tile = nullptr;
  const ComposeStrengths* strengths = nullptr;
  // Output: RGBA half floats of the tile's texels. `slopes`: the slope and its squares plus the
  // variance (WithMoments() of render/wrinkles/derivative_map.h). `colours`: colour, and cavity in
  // alpha.
  std::span<std::uint16_t> slopes;
  std::span<std::uint16_t> colours;         // empty if the tile has no colour
  std::size_t stride = ComposeTile::kSide;  // texels from one row to the next, at least kSide

  // False: a list is too short for the others, or a mask's channel is out of range.
  [[nodiscard]] bool Validate() const;
  // False: not valid; nothing was written.
  [[nodiscard]] bool Run() const;
};

}  // namespace furrow::render
