// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/dilate.h"

#include <cstddef>
#include <type_traits>

namespace furrow::authoring {
namespace {

constexpr std::uint8_t kOutside = 255;

}  // namespace

// Numbers the texels around the covered area ring by ring, once for all planes. Neighbours wrap
// around the edges, as the sampler does.
Dilation::Dilation(const std::vector<std::uint8_t>& covered, int width, int height, int rings)
    : width_(width), height_(height), ring_(covered.size(), kOutside) {
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (covered[i]) ring_[i] = 0;
  }
  std::vector<std::size_t> ring;
  const auto add_neighbours = [&](std::size_t texel, std::uint8_t number) {
    VisitNeighbours(texel, [&](std::size_t near) {
      if (ring_[near] != kOutside) return;
      ring_[near] = number;
      ring.push_back(near);
    });
  };
  for (int number = 1; number <= rings; ++number) {
    if (number == 1) {
      for (std::size_t i = 0; i < covered.size(); ++i) {
        if (covered[i]) add_neighbours(i, 1);
      }
    } else {
      for (const std::size_t texel : texels_.back()) {
        add_neighbours(texel, static_cast<std::uint8_t>(number));
      }
    }
    if (ring.empty()) break;
    texels_.push_back(std::move(ring));
    ring.clear();
  }
}

template <class Visit>
void Dilation::VisitNeighbours(std::size_t texel, const Visit& visit) const {
  const int x = static_cast<int>(texel % static_cast<std::size_t>(width_));
  const int y = static_cast<int>(texel / static_cast<std::size_t>(width_));
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int nx = (x + dx + width_) % width_, ny = (y + dy + height_) % height_;
      visit(static_cast<std::size_t>(ny) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(nx));
    }
  }
}

// A texel becomes the mean of its neighbours on inner rings. Rings run outward, so these are
// complete. Each has at least one, because a neighbour put the texel on its ring.
template <class T>
void Dilation::Apply(int channels, std::vector<T>* plane) const {
  using Sum = std::conditional_t<std::is_floating_point_v<T>, T, std::uint32_t>;
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t number = 1; number <= texels_.size(); ++number) {
    for (const std::size_t texel : texels_[number - 1]) {
      for (std::size_t c = 0; c < stride; ++c) {
        Sum sum = 0;
        std::uint32_t count = 0;
        VisitNeighbours(texel, [&](std::size_t near) {
          if (ring_[near] >= number) return;
          sum += (*plane)[near * stride + c];
          ++count;
        });
        if constexpr (std::is_floating_point_v<T>) {
          (*plane)[texel * stride + c] = sum / static_cast<T>(count);
        } else {
          // Rounds to the nearest integer.
          (*plane)[texel * stride + c] = static_cast<T>((sum + count / 2) / count);
        }
      }
    }
  }
}

template void Dilation::Apply(int, std::vector<std::uint8_t>*) const;
template void Dilation::Apply(int, std::vector<std::uint16_t>*) const;
template void Dilation::Apply(int, std::vector<float>*) const;

void Dilate(character::Picture* picture, const std::vector<SurfaceTexel>& texels, int rings) {
  const auto width = static_cast<std::size_t>(picture->width);
  std::vector<std::uint8_t> covered(width * static_cast<std::size_t>(picture->height), 0);
  for (const SurfaceTexel& texel : texels) {
    covered[static_cast<std::size_t>(texel.y) * width + static_cast<std::size_t>(texel.x)] = 1;
  }
  const Dilation dilation(covered, picture->width, picture->height, rings);
  if (picture->pixels16.empty()) {
    dilation.Apply(picture->channels, &picture->pixels);
  } else {
    dilation.Apply(picture->channels, &picture->pixels16);
  }
}

}  // namespace furrow::authoring
