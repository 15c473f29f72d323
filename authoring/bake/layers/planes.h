// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace furrow::character::bake {

// Grows planes of floats over the texels that no triangle covers, ring by ring, each texel the mean
// of its neighbours that have a value: so filtering and mip levels at a UV border find folds and
// not nothing. `planes`: each `channels` floats a texel.
struct FloatPlane {
  std::vector<float>* texels;
  int channels;
};
void DilatePlanes(std::span<const FloatPlane> planes, const std::vector<std::uint8_t>& covered,
                  int width, int height, int rings);

// Calls work(first, last) for runs of [0, count) on `threads` threads, this one among them; which
// thread gets which run is left to chance, so work must write to its own run alone. `progress` is
// called here with [0, 1]; false stops. Returns false when stopped.
[[nodiscard]] bool ForRuns(std::size_t count, int threads,
                           const std::function<void(std::size_t, std::size_t)>& work,
                           const std::function<bool(float)>& progress);

}  // namespace furrow::character::bake
