// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace furrow::gltf {

// One animation sampler: keys in time, `width` numbers each (glTF 2.0, appendix C).
//
// - LINEAR interpolates between neighbours; rotations by slerp along the shorter arc.
// - STEP holds the earlier key.
// - CUBICSPLINE is a Hermite spline with tangents per second.
// - The first value holds before the first key, the last value after the last key.
struct Track {
  enum class Interpolation : std::uint8_t { kLinear, kStep, kCubicSpline };

  Interpolation interpolation = Interpolation::kLinear;
  bool is_rotation = false;  // width 4: x y z w; results are normalised
  std::size_t width = 0;
  std::shared_ptr<const std::vector<float>> times;  // seconds, strictly increasing, not empty
  std::vector<float> values;  // `width` per key; cubic: in-tangent, value, out-tangent per key

  // Writes `width` numbers to `out`.
  void Evaluate(double time, float* out) const;
  // The `width` numbers of a key.
  [[nodiscard]] const float* Value(std::size_t key) const;

 private:
  void Interpolate(std::size_t key, float t, float* out) const;
  void EvaluateSpline(std::size_t key, float t, float span, float* out) const;
};

}  // namespace furrow::gltf
