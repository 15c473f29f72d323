// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "authoring/paint/surface_texels.h"
#include "character/pictures/picture.h"

namespace furrow::authoring {

// Spreads painted texels over the unpainted texels around them, ring by ring. Filtering and mip
// levels near a UV seam then read painted values instead of the background.
//
// Each new texel is the mean of its neighbours (up to 8) that are covered or lie in an earlier
// ring. The picture wraps around at its edges, like the sampler.
class Dilation {
 public:
  // `covered`: one entry per texel, rows from the top, nonzero where painted. `rings`: how many
  // texels to grow, [0, 254].
  Dilation(const std::vector<std::uint8_t>& covered, int width, int height, int rings);

  // Fills the rings of a plane that has `channels` values per texel. T: std::uint8_t,
  // std::uint16_t (the mean is rounded) or float.
  template <class T>
  void Apply(int channels, std::vector<T>* plane) const;

 private:
  template <class Visit>
  void VisitNeighbours(std::size_t texel, const Visit& visit) const;

  int width_;
  int height_;
  std::vector<std::uint8_t> ring_;                // 0: covered; 1, 2, ...: ring; 255: outside
  std::vector<std::vector<std::size_t>> texels_;  // of each ring
};

// Rings for pictures that are drawn with mip maps: 16 texels cover a UV seam down to the fourth mip
// level.
inline constexpr int kSeamTexels = 16;

// Dilates a picture of 8 or 16 bits per channel that was painted at `texels`. `rings`: how many
// texels to grow, [0, 254].
void Dilate(character::Picture* picture, const std::vector<SurfaceTexel>& texels, int rings);

}  // namespace furrow::authoring
