// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::authoring {

// The parameters of a face. Shape, colour, hair and the depth of wrinkles depend on them. Landmarks
// and joints are the same for every face, so recordings and rigs fit all faces.
struct FaceParameters {
  float sex = 1.0f;    // -1 a woman, 0 neutral, 1 a man; values between are mixtures
  float age = 30.0f;   // years, 18 to 90
  float grey = -1.0f;  // fraction of grey hair, [0, 1]; negative: depends on the age
};

// 0 up to 25 years, 1 at 75 years.
[[nodiscard]] constexpr float AgeShare(const FaceParameters& face) {
  const float t = (face.age - 25.0f) / 50.0f;
  return t < 0.0f ? 0.0f : (t > 1.3f ? 1.3f : t);
}

// The factor of the wrinkle maps' depth: below 1 for the young, 1 at 30 years, deep in old age.
[[nodiscard]] constexpr float WrinkleDepth(const FaceParameters& face) {
  const float young = 0.75f + 0.25f * (face.age - 18.0f) / 12.0f;
  return face.age < 30.0f ? (young < 0.75f ? 0.75f : young) : 1.0f + 0.9f * AgeShare(face) - 0.09f;
}

[[nodiscard]] constexpr float GreyShare(const FaceParameters& face) {
  if (face.grey >= 0.0f) return face.grey > 1.0f ? 1.0f : face.grey;
  const float t = (face.age - 38.0f) / 32.0f;
  return t < 0.0f ? 0.0f : (t > 0.92f ? 0.92f : t);
}

}  // namespace furrow::authoring
