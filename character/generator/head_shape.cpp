// SPDX-License-Identifier: Apache-2.0
#include "character/generator/head_shape.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::character::generator {
namespace {

using glm::vec3;

// Union, rounded over about `k` centimetres where the two surfaces meet (Quilez's polynomial form).
float Join(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - h * h * k * 0.25f;
}

float Cut(float a, float b, float k) { return -Join(-a, b, k); }

float Ellipsoid(const vec3& p, const vec3& centre, const vec3& radii) {
  const vec3 d = p - centre;
  const float k0 = glm::length(d / radii);
  const float k1 = glm::length(d / (radii * radii));
  return k1 > 1e-6f ? k0 * (k0 - 1.0f) / k1 : -std::min({radii.x, radii.y, radii.z});
}

// A capsule whose radius runs from ra to rb.
float Limb(const vec3& p, const vec3& a, const vec3& b, float ra, float rb) {
  const vec3 ab = b - a;
  const float t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::length(p - a - ab * t) - (ra + (rb - ra) * t);
}

float Skull(const vec3& q) {
  float d = Ellipsoid(q, {0, 3.1f, -1.1f}, {7.45f, 8.4f, 9.5f});
  d = Join(d, Ellipsoid(q, {0, 4.6f, 3.2f}, {6.2f, 5.0f, 5.9f}), 3.0f);    // forehead
  d = Join(d, Ellipsoid(q, {0, -2.0f, 2.4f}, {6.0f, 8.0f, 6.5f}), 2.5f);   // face
  d = Join(d, Ellipsoid(q, {0, -5.8f, 4.6f}, {3.9f, 3.9f, 4.75f}), 2.0f);  // maxilla
  return d;
}

float Jaw(const vec3& q) {
  float d = Limb(q, {4.95f, -6.6f, 0.3f}, {1.9f, -9.9f, 6.6f}, 1.1f, 1.4f);
  d = Join(d, Limb(q, {5.6f, -1.0f, -0.6f}, {4.95f, -6.6f, 0.3f}, 1.0f, 1.1f), 1.5f);
  d = Join(d, Ellipsoid(q, {0, -9.95f, 7.55f}, {1.9f, 1.35f, 1.65f}), 1.6f);  // chin
  d = Join(d, Ellipsoid(q, {0, -8.2f, 3.2f}, {4.6f, 2.4f, 4.8f}), 1.8f);      // floor of the mouth
  return d;
}

float Neck(const vec3& q) {
  float d = Limb(q, {0, -6.0f, -2.6f}, {0, -22.0f, -5.2f}, 5.0f, 5.6f);
  d = Join(d, Limb(q, {5.6f, -3.5f, -3.2f}, {1.3f, -19.5f, 0.6f}, 0.8f, 0.9f),
           1.4f);                                                          // sternomastoid
  d = Join(d, Ellipsoid(q, {0, -14.3f, 1.6f}, {0.9f, 1.3f, 0.9f}), 1.2f);  // larynx
  d = Join(d, Limb(q, {2.4f, -9.0f, -7.0f}, {7.0f, -23.5f, -7.2f}, 1.5f, 2.2f), 3.0f);  // trapezius
  return d;
}

float CheekAndBrow(float d, const vec3& q) {
  d = Join(d, Limb(q, {4.4f, -2.3f, 5.75f}, {6.1f, -1.3f, 1.2f}, 1.25f, 0.9f), 1.7f);  // cheekbone
  d = Join(d, Ellipsoid(q, {3.7f, -4.6f, 5.6f}, {2.2f, 2.6f, 2.5f}), 2.0f);            // cheek
  d = Join(d, Limb(q, {1.0f, 1.75f, 8.45f}, {4.6f, 2.1f, 6.5f}, 0.75f, 0.75f), 1.3f);  // brow
  d = Join(d, Ellipsoid(q, {0, 2.1f, 8.3f}, {1.5f, 1.1f, 1.0f}), 1.2f);                // glabella
  return d;
}

float EyeSocket(float d, const vec3& q) {
  d = Cut(d, Ellipsoid(q, {3.15f, 0.05f, 9.0f}, {1.95f, 1.3f, 1.55f}), 1.1f);
  d = Cut(d, Ellipsoid(q, {1.35f, 0.2f, 9.5f}, {0.75f, 1.1f, 1.1f}), 0.9f);  // beside the root
  // Lids: a shell over the ball, longer than high so that it runs out at the corners.
  const float lids = Ellipsoid(q, kEyeCentre, {1.64f, 1.43f, 1.42f});
  d = Join(d, lids, 0.35f);
  // The fold over the upper lid.
  d = Cut(d, Limb(q, {2.2f, 0.74f, 8.25f}, {4.2f, 0.78f, 7.65f}, 0.10f, 0.10f), 0.3f);
  return d;
}

float Nose(float d, const vec3& q) {
  float nose = Limb(q, {0, 0.8f, 8.25f}, {0, -3.2f, 10.25f}, 0.62f, 0.62f);
  nose = Join(nose, Limb(q, {0.6f, -0.6f, 8.2f}, {0.95f, -3.6f, 9.2f}, 0.5f, 0.75f), 0.9f);
  nose = Join(nose, Ellipsoid(q, {0, -3.75f, 10.65f}, {0.92f, 0.85f, 0.95f}), 0.7f);   // tip
  nose = Join(nose, Ellipsoid(q, {1.2f, -4.1f, 9.55f}, {0.58f, 0.68f, 0.9f}), 0.45f);  // wing
  d = Join(d, nose, 0.8f);
  d = Join(d, Limb(q, {0, -4.5f, 10.7f}, {0, -4.95f, 9.5f}, 0.3f, 0.35f), 0.35f);  // columella
  d = Cut(d, Limb(q, {0.62f, -5.1f, 10.0f}, {0.66f, -4.0f, 9.75f}, 0.32f, 0.25f),
          0.25f);  // nostril
  return d;
}

float Lips(float d, const vec3& q) {
  float upper = Limb(q, {0.0f, -6.5f, 9.5f}, {0.6f, -6.42f, 9.5f}, 0.45f, 0.48f);
  upper = Join(upper, Limb(q, {0.6f, -6.42f, 9.5f}, {2.6f, kMouthY, 8.15f}, 0.48f, 0.22f), 0.2f);
  float lower = Limb(q, {0.0f, -7.52f, 9.3f}, {0.9f, -7.48f, 9.15f}, 0.6f, 0.56f);
  lower = Join(lower, Limb(q, {0.9f, -7.48f, 9.15f}, {2.5f, -7.0f, 8.15f}, 0.56f, 0.22f), 0.25f);
  d = Join(d, upper, 0.5f);
  d = Cut(d, Limb(q, {0, -5.0f, 9.75f}, {0, -6.05f, 9.95f}, 0.16f, 0.26f), 0.35f);  // philtrum
  d = Cut(d, Limb(q, {0, -8.55f, 9.75f}, {1.4f, -8.35f, 9.3f}, 0.35f, 0.2f),
          0.8f);  // under the lip
  d = Join(d, lower, 0.45f);
  // The line between the lips and its dip at the corners.
  d = Cut(d, Limb(q, {0, kMouthY, 10.1f}, {2.3f, kMouthY, 8.85f}, 0.06f, 0.06f), 0.3f);
  d = Cut(d, Ellipsoid(q, {2.72f, kMouthY, 8.6f}, {0.22f, 0.3f, 0.4f}), 0.4f);
  return d;
}

// Faces are not symmetric: a smooth warp of 1 to 2 mm.
vec3 Asymmetry(const vec3& p) {
  vec3 w = p;
  w.x += 0.10f * std::exp(-(p.y + 4.0f) * (p.y + 4.0f) / 8.0f);         // nose leans
  w.y += 0.06f * std::tanh(p.x * 0.6f) * std::exp(-p.y * p.y / 20.0f);  // one eye higher
  w.y -= 0.07f * std::tanh(p.x * 0.5f) * std::exp(-(p.y + 7.0f) * (p.y + 7.0f) / 6.0f);
  return w;
}

}  // namespace

glm::vec3 HeadToModel(const glm::vec3& p) { return (p + kHeadOrigin) * 0.01f; }
glm::vec3 ModelToHead(const glm::vec3& p) { return p * 100.0f - kHeadOrigin; }

float HeadDistance(const glm::vec3& p) {
  const vec3 w = Asymmetry(p);
  const vec3 q(std::abs(w.x), w.y, w.z);
  float d = Join(Skull(q), Jaw(q), 1.8f);
  d = CheekAndBrow(d, q);
  d = Join(d, Neck(q), 1.6f);
  d = EyeSocket(d, q);
  d = Nose(d, q);
  return Lips(d, q);
}

glm::vec3 HeadNormal(const glm::vec3& p) {
  constexpr float kStep = 0.02f;
  // Four taps of a tetrahedron.
  const vec3 a(1, -1, -1), b(-1, -1, 1), c(-1, 1, -1), e(1, 1, 1);
  return glm::normalize(a * HeadDistance(p + a * kStep) + b * HeadDistance(p + b * kStep) +
                        c * HeadDistance(p + c * kStep) + e * HeadDistance(p + e * kStep));
}

glm::vec3 CastOnHead(const glm::vec3& from, const glm::vec3& direction, float length) {
  constexpr float kSafety = 0.6f;  // the distance is an estimate
  float t = 0.0f;
  for (int i = 0; i < 160 && t < length; ++i) {
    const float d = HeadDistance(from + direction * t);
    if (d < 0.0005f) break;
    t += std::max(d * kSafety, 0.0005f);
  }
  return from + direction * std::min(t, length);
}

}  // namespace furrow::character::generator
