// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace furrow::motion {

// One glTF animation sampler: keys in time, `width` numbers each.
//
// LINEAR mixes the neighbours (quaternions by slerp along the shorter way), STEP keeps the earlier,
// CUBICSPLINE is glTF's Hermite spline with tangents per second (appendix C of the specification).
// Before the first key the first value holds, after the last the last.
struct GltfTrack {
  enum class Interpolation { kLinear, kStep, kCubicSpline };

  Interpolation interpolation = Interpolation::kLinear;
  bool is_rotation = false;  // width 4, x y z w, results normalised
  std::size_t width = 0;
  std::shared_ptr<const std::vector<float>> times;  // seconds, strictly increasing, not empty
  std::vector<float> values;  // width a key; cubic: in-tangent, value, out-tangent, width each

  // Writes `width` numbers to `out`.
  void Evaluate(double time, float* out) const;
  // The `width` numbers of key `key`.
  [[nodiscard]] const float* Value(std::size_t key) const;

 private:
  void Mix(std::size_t key, float t, float* out) const;
  void Spline(std::size_t key, float t, float span, float* out) const;
};

}  // namespace furrow::motion
