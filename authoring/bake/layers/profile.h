// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::character::bake {

// The section of a row of folds: a function of the phase, 2 pi from valley to valley, which is even
// about the valley at phase 0, runs from -1 and 1 apart by 2, and has the mean 0.
//
//   p = 2 (q - mean) / (max - min),  q = s^2 / (s^2 + w^2),  s = sin(phase / 2)
// A small w makes a narrow valley between broad, round ridges (skin), a large one nearly a sine
// (cloth).
class FoldProfile {
 public:
  // `sharpness` in [0, 1]; see BakeMaterial.
  explicit FoldProfile(float sharpness);

  struct Sample {
    float height = 0.0f;
    float slope = 0.0f;  // by the phase
  };
  // From the cosine and sine of the phase.
  [[nodiscard]] Sample At(float cosine, float sine) const;

  // Half the height from valley to ridge that keeps the arc as long as the surface was before it
  // was compressed, as a fraction of wavelength / (2 pi), for compressions in [0, 0.95]:
  //   mean over the phase of sqrt((1 - compression)^2 + (amplitude * p')^2) = 1
  // For a sine and a small compression that is 2 sqrt(compression): A = (lambda / pi) sqrt(e).
  [[nodiscard]] float Amplitude(float compression) const;

 private:
  [[nodiscard]] float SolveAmplitude(float compression) const;

  float w2_ = 1.0f;
  float mean_ = 0.0f;
  float scale_ = 1.0f;
  std::vector<float> amplitudes_;  // by the root of the compression, evenly
};

}  // namespace furrow::character::bake
