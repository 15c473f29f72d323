// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "character/character.h"
#include "render/renderer.h"
#include "tests/unit/render/reference/ray_cast.h"

// Analytic scenes as characters with one joint and no rig.
namespace furrow::render::test {

// One half of a card.
struct CardHalf {
  character::Material::Kind kind = character::Material::Kind::kSkin;
  float albedo = 1.0f;  // grey
};

// A card of `width` x `height` metres around the origin in the plane z = 0 that faces +Z. The plane
// x = 0 divides it into two halves.
[[nodiscard]] character::Character MakeCard(float width, float height, const CardHalf& left,
                                            const CardHalf& right);

// A white sphere over a white plane of `plane_size` metres, both skin, one mesh each.
[[nodiscard]] character::Character MakeSphereOnPlane(const SphereOnPlane& scene, float plane_size);

// A camera at `position` that looks down at the middle of such a scene.
[[nodiscard]] Camera SphereCamera(const glm::vec3& position);

// A camera in front of the origin that looks along -Z and shows the plane z = 0 at `mm_per_pixel`
// in a picture of `height` pixels.
[[nodiscard]] Camera CardCamera(float mm_per_pixel, int height);

// The ray through the centre of a pixel, rows from the bottom.
struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0};  // unit
};
[[nodiscard]] Ray PixelRay(const Camera& camera, int x, int y, int width, int height);

// The surface point at the centre of a pixel: on the sphere, or on the plane within `plane_size`.
struct Hit {
  glm::dvec3 point{0.0};
  glm::dvec3 normal{0.0};
  bool on_sphere = false;
};
[[nodiscard]] std::optional<Hit> FirstHit(const SphereOnPlane& scene, double plane_size,
                                          const Ray& ray);

// A request for a character of one joint at rest, without wrinkles, with one sample per pixel. The
// character must outlive the request.
[[nodiscard]] FrameRequest SceneRequest(const character::Character& character, const Camera& camera,
                                        int width, int height);

}  // namespace furrow::render::test
