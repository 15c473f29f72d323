// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace furrow::character::generator {

// Head space: centimetres, origin between the eyes at half the head's height and half its depth, +Y
// up, +Z out of the face, +X the subject's left. Model space is metres: (p + kHeadOrigin) / 100.
inline constexpr glm::vec3 kHeadOrigin{0.0f, 163.5f, 1.0f};

// Landmarks, averages of an adult head (docs/DEFAULT-CHARACTER.md). x for the left side.
inline constexpr glm::vec3 kEyeCentre{3.2f, 0.0f, 7.05f};
inline constexpr float kEyeRadius = 1.2f;
inline constexpr float kInnerCanthusX = 1.72f;
inline constexpr float kOuterCanthusX = 4.66f;
inline constexpr float kMouthCornerX = 2.52f;
inline constexpr float kMouthY = -6.95f;

[[nodiscard]] glm::vec3 HeadToModel(const glm::vec3& p);
[[nodiscard]] glm::vec3 ModelToHead(const glm::vec3& p);

// A function that is negative inside the head, positive outside, and changes by about 1 a
// centimetre: skull, face and neck as smooth unions of round bodies, slightly asymmetric as faces
// are. Lids are closed over the eyes up to their openings, the lips meet at the mouth's line; ears,
// eyeballs and hair are meshes of their own.
[[nodiscard]] float HeadDistance(const glm::vec3& p);

// Unit gradient of HeadDistance.
[[nodiscard]] glm::vec3 HeadNormal(const glm::vec3& p);

// The first point of the surface on the ray from `from` (outside) along unit `direction`; stops at
// `length` centimetres where it meets nothing.
[[nodiscard]] glm::vec3 CastOnHead(const glm::vec3& from, const glm::vec3& direction, float length);

}  // namespace furrow::character::generator
