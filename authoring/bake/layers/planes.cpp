// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/planes.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace furrow::character::bake {
namespace {

constexpr std::size_t kRun = 8192;

// The texels around one, wrapping as the sampler does.
class Ring {
 public:
  Ring(int width, int height) : width_(width), height_(height) {}

  template <class Visit>
  void Around(std::size_t texel, const Visit& visit) const {
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

 private:
  int width_;
  int height_;
};

void FillFromNeighbours(const FloatPlane& plane, const Ring& ring,
                        const std::vector<std::uint8_t>& known, std::size_t texel) {
  const auto channels = static_cast<std::size_t>(plane.channels);
  for (std::size_t c = 0; c < channels; ++c) {
    float sum = 0.0f;
    int count = 0;
    ring.Around(texel, [&](std::size_t near) {
      if (!known[near]) return;
      sum += (*plane.texels)[near * channels + c];
      ++count;
    });
    (*plane.texels)[texel * channels + c] = sum / static_cast<float>(std::max(count, 1));
  }
}

}  // namespace

void DilatePlanes(std::span<const FloatPlane> planes, const std::vector<std::uint8_t>& covered,
                  int width, int height, int rings) {
  const Ring ring(width, height);
  std::vector<std::uint8_t> known = covered;
  std::vector<std::uint8_t> queued = covered;
  std::vector<std::size_t> front, next;
  const auto queue = [&](std::size_t texel, std::vector<std::size_t>* to) {
    ring.Around(texel, [&](std::size_t near) {
      if (queued[near]) return;
      queued[near] = 1;
      to->push_back(near);
    });
  };
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (covered[i]) queue(i, &front);
  }
  for (int step = 0; step < rings && !front.empty(); ++step) {
    for (const FloatPlane& plane : planes) {
      for (const std::size_t texel : front) FillFromNeighbours(plane, ring, known, texel);
    }
    next.clear();
    for (const std::size_t texel : front) known[texel] = 1;
    for (const std::size_t texel : front) queue(texel, &next);
    front.swap(next);
  }
}

bool ForRuns(std::size_t count, int threads,
             const std::function<void(std::size_t, std::size_t)>& work,
             const std::function<bool(float)>& progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  const auto one = [&] {
    const std::size_t first = next.fetch_add(kRun);
    if (first >= count || stopped) return false;
    work(first, std::min(first + kRun, count));
    return true;
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) {
    others.emplace_back([&] {
      while (one()) {
      }
    });
  }
  while (one()) {
    const float done = static_cast<float>(std::min(next.load(), count)) / static_cast<float>(count);
    if (progress && !progress(done)) stopped = true;
  }
  others.clear();  // joins
  if (!stopped && progress && !progress(1.0f)) stopped = true;
  return !stopped;
}

}  // namespace furrow::character::bake
