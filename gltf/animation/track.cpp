// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation/track.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace furrow::gltf {
namespace {

glm::quat LoadQuat(const float* xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

void StoreUnit(const glm::quat& q, float* xyzw) {
  const float length = glm::length(q);
  // A spline between opposite quaternions may pass through zero, where no rotation is defined.
  const glm::quat unit = length > 1e-6f ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  xyzw[0] = unit.x, xyzw[1] = unit.y, xyzw[2] = unit.z, xyzw[3] = unit.w;
}

}  // namespace

const float* Track::Value(std::size_t key) const {
  // The value of a spline's key is the second of its three elements.
  const bool cubic = interpolation == Interpolation::kCubicSpline;
  return values.data() + (cubic ? key * 3 + 1 : key) * width;
}

void Track::Interpolate(std::size_t key, float t, float* out) const {
  const float* a = Value(key);
  const float* b = Value(key + 1);
  if (is_rotation) {
    StoreUnit(glm::slerp(glm::normalize(LoadQuat(a)), glm::normalize(LoadQuat(b)), t), out);
    return;
  }
  for (std::size_t i = 0; i < width; ++i) out[i] = std::lerp(a[i], b[i], t);
}

// The cubic Hermite spline of glTF 2.0, appendix C.5. Tangents are per second, hence the factor
// `span`.
void Track::EvaluateSpline(std::size_t key, float t, float span, float* out) const {
  const float t2 = t * t;
  const float t3 = t2 * t;
  const float* out_tangent = Value(key) + width;
  const float* in_tangent = Value(key + 1) - width;
  for (std::size_t i = 0; i < width; ++i) {
    out[i] = (2.0f * t3 - 3.0f * t2 + 1.0f) * Value(key)[i] +
             span * (t3 - 2.0f * t2 + t) * out_tangent[i] +
             (-2.0f * t3 + 3.0f * t2) * Value(key + 1)[i] + span * (t3 - t2) * in_tangent[i];
  }
  if (is_rotation) StoreUnit(LoadQuat(out), out);
}

void Track::Evaluate(double time, float* out) const {
  const std::vector<float>& keys = *times;
  const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, float key) { return t < double{key}; });
  const auto next = static_cast<std::size_t>(after - keys.begin());
  // Before the first key and after the last one, the nearest key holds.
  if (next == 0 || next == keys.size() || interpolation == Interpolation::kStep) {
    std::copy_n(Value(next == 0 ? 0 : next - 1), width, out);
    if (is_rotation) StoreUnit(LoadQuat(out), out);
    return;
  }
  // Above 0, because the times increase strictly.
  const float span = keys[next] - keys[next - 1];
  const auto t = static_cast<float>((time - double{keys[next - 1]}) / double{span});
  if (interpolation == Interpolation::kLinear) {
    Interpolate(next - 1, t, out);
  } else {
    EvaluateSpline(next - 1, t, span, out);
  }
}

}  // namespace furrow::gltf
