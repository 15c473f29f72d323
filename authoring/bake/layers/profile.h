// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::authoring {

// The cross-section of a row of folds, as a function p of the phase with period 2 pi. It is
// symmetric about the valley at phase 0, has the mean 0, and rises by 2 from its lowest to its
// highest point.
//
//   p = 2 (q - mean) / (max - min),  q = s^2 / (s^2 + w^2),  s = sin(phase / 2)
// A small w gives a narrow valley between broad, round ridges (skin); a large w is nearly a sine
// (cloth).
class FoldProfile {
 public:
  // `sharpness`: 0 gives nearly a sine, 1 a narrow crease between round ridges.
  explicit FoldProfile(float sharpness);

  struct Sample {
    float height = 0.0f;
    float slope = 0.0f;  // derivative by the phase
  };
  // Evaluates the profile from the cosine and sine of the phase.
  [[nodiscard]] Sample At(float cosine, float sine) const;

  // The amplitude (half the height from valley to ridge) that preserves the length of the surface,
  // as a multiple of wavelength / (2 pi). `compression`: [0, 0.95]. It solves
  //   mean over the phase of sqrt((1 - compression)^2 + (amplitude * p')^2) = 1
  // For a sine and a small compression this is 2 sqrt(compression): A = (lambda / pi) sqrt(e).
  [[nodiscard]] float Amplitude(float compression) const;

 private:
  float w2_ = 1.0f;
  float mean_ = 0.0f;
  float scale_ = 1.0f;
  std::vector<float> amplitudes_;  // tabulated at even steps of the square root of the compression
};

}  // namespace furrow::authoring
