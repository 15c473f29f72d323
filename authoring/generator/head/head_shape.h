// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/face_parameters.h"
#include "authoring/generator/head/head_primitives.h"

namespace furrow::authoring {

// Head space: centimetres. The origin is between the eyes, at half the height and half the depth of
// the head; +Y up, +Z out of the face, +X the subject's left. A point `p` is at
// (p + kHeadOrigin) / 100 in model space, which is in metres.
inline constexpr glm::vec3 kHeadOrigin{0.0f, 163.5f, 1.0f};

// Landmarks on the left side in head space, centimetres: means of adult heads
// (docs/DEFAULT-CHARACTER.md). They are the same for every face.
inline constexpr glm::vec3 kEyeCentre{3.2f, 0.0f, 7.22f};
inline constexpr float kEyeRadius = 1.2f;
inline constexpr float kInnerCanthusX = 1.72f;
inline constexpr float kOuterCanthusX = 4.66f;
inline constexpr float kMouthCornerX = 2.52f;
inline constexpr float kMouthY = -6.90f;

// The centre of an eyeball in head space, centimetres, the same for every face. `side`: +1 for the
// subject's left, -1 for the right.
[[nodiscard]] glm::vec3 EyeCentre(float side);

// Convert a point from head space (centimetres) to model space (metres), and back.
[[nodiscard]] glm::vec3 HeadToModel(const glm::vec3& p);
[[nodiscard]] glm::vec3 ModelToHead(const glm::vec3& p);

// The shape of one head as a signed distance: skull, face and neck in one piece, slightly
// asymmetric. The eyelids leave an opening for each eye; the lips are closed. Ears, eyeballs and
// hair are separate meshes. All points are in head space, centimetres.
class HeadShape {
 public:
  explicit HeadShape(const FaceParameters& face = {});

  [[nodiscard]] const FaceParameters& face() const { return face_; }
  // The distance from `p` to the surface, centimetres; negative inside. Exact only near the
  // surface.
  [[nodiscard]] float Distance(const glm::vec3& p) const;
  // Unit gradient of Distance().
  [[nodiscard]] glm::vec3 Normal(const glm::vec3& p) const;
  // The first point of the surface on the ray from `from` (outside) along the unit vector
  // `direction`, or the point at `length` centimetres if there is none.
  [[nodiscard]] glm::vec3 Cast(const glm::vec3& from, const glm::vec3& direction,
                               float length) const;

 private:
  FaceParameters face_;
  std::vector<HeadPrimitive> primitives_;
  std::vector<Bulge> bulges_;
};

// The head of the default character, made on the first call. Thread-safe.
[[nodiscard]] const HeadShape& DefaultHead();

}  // namespace furrow::authoring
