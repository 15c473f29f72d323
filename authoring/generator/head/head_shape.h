// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/face_parameters.h"
#include "authoring/generator/head/head_primitives.h"

namespace furrow::authoring {

// Head space: centimetres, origin between the eyes at half the head's height and half its depth, +Y
// up, +Z out of the face, +X the subject's left. Model space is metres: (p + kHeadOrigin) / 100.
inline constexpr glm::vec3 kHeadOrigin{0.0f, 163.5f, 1.0f};

// Landmarks, averages of an adult head (docs/DEFAULT-CHARACTER.md). x for the left side.
inline constexpr glm::vec3 kEyeCentre{3.2f, 0.0f, 7.22f};
inline constexpr float kEyeRadius = 1.2f;
inline constexpr float kInnerCanthusX = 1.72f;
inline constexpr float kOuterCanthusX = 4.66f;
inline constexpr float kMouthCornerX = 2.52f;
inline constexpr float kMouthY = -6.90f;

[[nodiscard]] glm::vec3 HeadToModel(const glm::vec3& p);
[[nodiscard]] glm::vec3 ModelToHead(const glm::vec3& p);

// The form of one head, as a function that is negative inside, positive outside, and changes by
// about 1 a centimetre: skull, face and neck in one piece, slightly asymmetric as faces are. Lids
// lie over the eyes up to their openings, the lips meet at the mouth's line; ears, eyeballs and
// hair are meshes of their own.
class HeadShape {
 public:
  explicit HeadShape(const FaceParameters& face = {});

  [[nodiscard]] const FaceParameters& face() const { return face_; }
  [[nodiscard]] float Distance(const glm::vec3& p) const;
  // Unit gradient of Distance().
  [[nodiscard]] glm::vec3 Normal(const glm::vec3& p) const;
  // The first point of the surface on the ray from `from` (outside) along unit `direction`; stops
  // at `length` centimetres where it meets nothing.
  [[nodiscard]] glm::vec3 Cast(const glm::vec3& from, const glm::vec3& direction,
                               float length) const;
  // The nearest point of the surface to one that is near it.
  [[nodiscard]] glm::vec3 Onto(glm::vec3 p) const;

 private:
  FaceParameters face_;
  std::vector<HeadPrimitive> primitives_;
  std::vector<Bulge> bulges_;
};

// The default character's.
[[nodiscard]] const HeadShape& DefaultHead();
[[nodiscard]] inline float HeadDistance(const glm::vec3& p) { return DefaultHead().Distance(p); }
[[nodiscard]] inline glm::vec3 HeadNormal(const glm::vec3& p) { return DefaultHead().Normal(p); }
[[nodiscard]] inline glm::vec3 CastOnHead(const glm::vec3& from, const glm::vec3& direction,
                                          float length) {
  return DefaultHead().Cast(from, direction, length);
}

}  // namespace furrow::authoring
