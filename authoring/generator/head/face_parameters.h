// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::authoring {

// The parameters of a generated face. They set its shape, colours, hair and depth of wrinkles.
// Every face has the same joints and landmarks (eyes, corners of the mouth) at the same positions,
// so recordings and rigs fit all faces.
struct FaceParameters {
  float sex = 1.0f;    // -1 female, 0 neutral, 1 male; values in between blend
  float age = 30.0f;   // years, [18, 90]
  float grey = -1.0f;  // fraction of grey hair, [0, 1]; negative: derived from `age`
};

// How aged a face is: 0 up to 25 years, then linear: 1 at 75 years, 1.3 from 90 years on.
[[nodiscard]] constexpr float AgeShare(const FaceParameters& face) {
  const float t = (face.age - 25.0f) / 50.0f;
  return t < 0.0f ? 0.0f : (t > 1.3f ? 1.3f : t);
}

// Multiplier for the depth of the wrinkle maps: 0.75 at 18 years, 1 at 30, about 2.1 at 90.
[[nodiscard]] constexpr float WrinkleDepth(const FaceParameters& face) {
  const float young = 0.75f + 0.25f * (face.age - 18.0f) / 12.0f;
  return face.age < 30.0f ? (young < 0.75f ? 0.75f : young) : 1.0f + 0.9f * AgeShare(face) - 0.09f;
}

// Fraction of grey hair, [0, 1]: `face.grey`, or if that is negative, 0 up to 38 years, then linear
// to 0.92 at 67 years and older.
[[nodiscard]] constexpr float GreyShare(const FaceParameters& face) {
  if (face.grey >= 0.0f) return face.grey > 1.0f ? 1.0f : face.grey;
  const float t = (face.age - 38.0f) / 32.0f;
  return t < 0.0f ? 0.0f : (t > 0.92f ? 0.92f : t);
}

}  // namespace furrow::authoring
