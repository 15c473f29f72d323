// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/blood.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

constexpr float kMaxChange =
    2.0f;  // largest factor of the area, or its inverse; more is a skinning artefact
constexpr float kPressedOut =
    0.25f;  // fraction of the blood that leaves the bottom of a deep furrow of other skin
constexpr float kMostStretch = 0.5f;
constexpr float kMostPressedOut = 0.5f;
constexpr float kAbsorbance = 0.36f;  // absorbance of green light by the blood at rest
const glm::vec3 kBlood(0.30f, 1.0f,
                       0.95f);  // absorption per colour channel: haemoglobin absorbs green and blue

}  // namespace

void BloodSum::Add(std::span<const float> growth, std::span<const float> weights) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const float area = std::clamp(growth[i], 1.0f / kMaxChange, kMaxChange);
    // The logarithm treats growth and shrinkage alike. The sum of fourth powers, with the root in
    // Take(), approximates the largest change but stays smooth where two poses are equally strong.
    const float change = -weights[i] * std::log(area);
    sums_[i] += change * std::abs(change) * change * change;
  }
}

std::vector<float> BloodSum::Take() const {
  std::vector<float> blood;
  blood.reserve(sums_.size());
  for (const float sum : sums_) {
    blood.push_back(std::exp(std::copysign(std::sqrt(std::sqrt(std::abs(sum))), sum)));
  }
  return blood;
}

float RidgeStretch(float arm_mm, float height_mm, float wavelength_mm) {
  const float wave = 2.0f * kPi / wavelength_mm;
  return std::clamp(arm_mm * height_mm * wave * wave, 0.0f, kMostStretch);
}

float PressedOut(float arm_mm, float cavity) {
  const float share = kPressedOut * arm_mm / BendArm(kOtherSkin) * (1.0f - cavity);
  return std::clamp(share, 0.0f, kMostPressedOut);
}

glm::vec3 BloodTint(float blood) {
  return glm::min(glm::exp(kBlood * (kAbsorbance * (1.0f - blood))), glm::vec3(kBloodTintScale));
}

}  // namespace furrow::authoring
