// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/profile.h"

#include <algorithm>
#include <cmath>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

constexpr int kPhases = 256;   // samples of a period for integrals
constexpr int kTable = 256;    // tabulated compressions
constexpr float kMax = 0.95f;  // largest compression

// Finds the amplitude for which the fold's arc is as long as the uncompressed surface: compressed
// skin buckles and keeps its length. `slopes`: of the profile, at even steps of the phase.
float SolveAmplitude(float compression, const std::vector<float>& slopes) {
  const float along = (1.0f - compression) * (1.0f - compression);
  const auto arc = [&](float amplitude) {
    double sum = 0.0;
    for (const float slope : slopes) {
      const float rise = amplitude * slope;
      sum += std::sqrt(along + rise * rise);
    }
    return sum / static_cast<double>(slopes.size());
  };
  float low = 0.0f, high = 8.0f;
  for (int i = 0; i < 40; ++i) {
    const float middle = 0.5f * (low + high);
    (arc(middle) < 1.0 ? low : high) = middle;
  }
  return 0.5f * (low + high);
}

}  // namespace

FoldProfile::FoldProfile(float sharpness) {
  const float blunt = 1.0f - sharpness;
  const float width = 0.12f + 2.0f * blunt * blunt;  // of the valley, as a sine of half the phase
  w2_ = width * width;
  double sum = 0.0;
  for (int i = 0; i < kPhases; ++i) {
    const float phase = 2.0f * kPi * static_cast<float>(i) / kPhases;
    const float s2 = 0.5f * (1.0f - std::cos(phase));
    sum += s2 / (s2 + w2_);
  }
  mean_ = static_cast<float>(sum / kPhases);
  scale_ = 2.0f * (1.0f + w2_);
  std::vector<float> slopes(kPhases);
  for (int i = 0; i < kPhases; ++i) {
    const float phase = 2.0f * kPi * (static_cast<float>(i) + 0.5f) / kPhases;
    slopes[static_cast<std::size_t>(i)] = At(std::cos(phase), std::sin(phase)).slope;
  }
  amplitudes_.resize(kTable + 1);
  for (int i = 1; i <= kTable; ++i) {
    // The amplitude grows like the root of the compression, so even steps of the root keep the
    // table precise near 0.
    const float root = static_cast<float>(i) / kTable;
    amplitudes_[static_cast<std::size_t>(i)] = SolveAmplitude(root * root * kMax, slopes);
  }
}

FoldProfile::Sample FoldProfile::At(float cosine, float sine) const {
  const float s2 = std::max(0.5f * (1.0f - cosine), 0.0f);
  const float q = 1.0f / (s2 + w2_);
  return {scale_ * (s2 * q - mean_), scale_ * 0.5f * sine * w2_ * q * q};
}

float FoldProfile::Amplitude(float compression) const {
  const float root = std::sqrt(std::clamp(compression, 0.0f, kMax) / kMax) * kTable;
  const auto cell = std::min(static_cast<std::size_t>(root), std::size_t{kTable - 1});
  const float within = root - static_cast<float>(cell);
  return amplitudes_[cell] + (amplitudes_[cell + 1] - amplitudes_[cell]) * within;
}

}  // namespace furrow::authoring
