// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace furrow::render {

// A square tile of one mip level of a material's textures, with everything that wrinkles can paint
// on it. Lists consist of planes of kTexels numbers, one per texel, row by row. Numbers are half
// floats unless stated otherwise. n is the unit normal in tangent space.
struct ComposeTile {
  static constexpr int kSide = 32;
  static constexpr std::size_t kTexels = std::size_t{kSide} * kSide;

  struct Map {
    std::vector<std::uint16_t> slopes;  // three planes: n.x / n.z, n.y / n.z, variance of slopes
    std::vector<std::uint16_t> looks;   // four planes: linear red, green, blue, and cavity; empty:
                                        // the map changes no colour
  };
  // One mask channel of the tile. Each value is 0 (the map is not drawn) to 255 (fully drawn).
  struct Mask {
    std::size_t channel = 0;  // channel index of ComposeStrengths::weights
    std::vector<std::uint8_t> values;
  };

  glm::ivec2 place{0};                // column and row of the tile; (0, 0) holds texel (0, 0)
  std::vector<std::uint16_t> slopes;  // of the base surface, as in Map
  std::vector<std::uint16_t> colour;  // base colour, linear red, green, blue; empty: no map has
                                      // looks
  float cavity_albedo = 0.0f;  // linear; base colours with less green are painted hollows, and
                               // wrinkles must not darken other texels below it
  std::vector<Map> maps;
  std::vector<Mask> masks;    // painted masks that are above 0 in the tile
  std::vector<Mask> skinned;  // masks by skin weight; their weighted sum is clamped to 1
};

// Strengths of everything that is painted on a tile.
struct ComposeStrengths {
  std::vector<float> weights;     // channels x maps, channel by channel: wrinkle weights, [0, 1]
  std::vector<float> amplitudes;  // per map: factor of its slopes
  std::vector<float> scales;      // per map: factor of its colour
  glm::vec2 looks{1.0f};          // x: strength of the maps' colours, y: of their cavities
};

// Paints the wrinkles of a tile on the CPU, as shaders/wrinkles/wrinkles_frag.glsl does per
// fragment (NormalBlend::kPartialDerivative). For map i with weight w_i, amplitude a_i and scale_i:
//
//   w_i      = sum over masks of weight * mask + min(sum over skinned of weight * mask, 1)
//   slope    = base slope + sum of a_i w_i slope_i
//   variance = base variance + sum of (a_i w_i)^2 variance_i
//   look     = product of max(1 + strength w_i (scale_i look_i - 1), 0)
//   colour   = base colour * look, but green stays at or above min(base green, cavity_albedo)
struct ComposeJob {
  const ComposeTile* tile = nullptr;            // required
  const ComposeStrengths* strengths = nullptr;  // required
  // Output: four half floats per texel. `slopes`: slope x and y, and the squares of both plus the
  // variance. `colours`: linear red, green and blue, and the cavity factor.
  std::span<std::uint16_t> slopes;
  std::span<std::uint16_t> colours;         // empty if the tile has no colour
  std::size_t stride = ComposeTile::kSide;  // texels from one row to the next, at least kSide

  // Returns false if a pointer is null, a list is too short for the others, or a mask's channel is
  // out of range.
  [[nodiscard]] bool Validate() const;
  // Writes the output. Returns false, and writes nothing, if Validate() fails.
  [[nodiscard]] bool Run() const;
};

}  // namespace furrow::render
