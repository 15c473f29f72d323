// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_shape.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

// The change of a primitive per unit of a trait.
struct Shift {
  const char* primitive;
  vec3 a;
  vec3 b;
  glm::vec2 r;
};

constexpr Shift kMan[] = {
    {"brow", {0.0f, -0.05f, 0.2f}, {0.1f, -0.08f, 0.12f}, {0.08f, 0.1f}},
    {"glabella", {0, -0.1f, 0.12f}, {0.05f, 0.05f, 0.08f}, {}},
    {"forehead", {0, 0, -0.12f}, {0.1f, 0, 0}, {}},
    {"jaw body", {0.3f, -0.15f, 0}, {0.25f, -0.12f, 0.1f}, {0.22f, 0.1f}},
    {"jaw branch", {0.1f, 0, 0}, {0.3f, -0.15f, 0}, {0.05f, 0.2f}},
    {"masseter", {0.15f, -0.2f, 0}, {0.12f, 0.1f, 0}, {}},
    {"chin", {0, -0.18f, 0.12f}, {0.3f, 0.05f, 0.1f}, {}},
    {"cheekbone", {0.1f, 0, 0.05f}, {0.1f, 0, 0}, {}},
    {"cheek", {0, 0, -0.12f}, {}, {}},
    {"neck", {}, {}, {0.4f, 0.25f}},
    {"sternomastoid", {0.25f, 0, 0}, {0.1f, 0, 0}, {0.15f, 0.15f}},
    {"larynx", {0, 0, 0.45f}, {0.05f, 0.1f, 0.1f}, {}},
    {"bridge", {0, 0.1f, 0.2f}, {0, -0.06f, 0.1f}, {0.04f, 0.03f}},
    {"side of the nose", {}, {0.05f, 0, 0.05f}, {0.05f, 0.03f}},
    {"tip", {0, -0.1f, 0.08f}, {0.02f, 0.04f, 0}, {}},
    {"wing", {0.04f, -0.04f, 0}, {0.03f, 0, 0.03f}, {}},
    {"upper lip", {0, 0, -0.06f}, {0, 0, -0.06f}, {-0.04f, -0.04f}},
    {"lower lip", {0, 0, -0.05f}, {0, 0, -0.05f}, {-0.04f, -0.04f}},
};

// The change from 25 to 75 years.
constexpr Shift kAge[] = {
    {"tip", {0, -0.2f, 0.1f}, {0.06f, 0.08f, 0.06f}, {}},
    {"wing", {0.06f, -0.1f, 0}, {0.05f, 0.05f, 0.05f}, {}},
    {"upper lip", {0, -0.03f, -0.12f}, {0, -0.03f, -0.12f}, {-0.07f, -0.07f}},
    {"upper lip to the corner", {0, 0, -0.1f}, {0, -0.06f, -0.05f}, {-0.08f, -0.05f}},
    {"lower lip", {0, 0, -0.1f}, {0, 0, -0.1f}, {-0.07f, -0.07f}},
    {"lower lip to the corner", {0, 0, -0.06f}, {0, -0.05f, -0.05f}, {-0.05f, -0.05f}},
    {"between the lips", {0, 0, -0.17f}, {0, 0, -0.1f}, {}},
    {"cheek", {0.1f, -0.35f, -0.15f}, {}, {}},
    {"cheek beside the mouth", {0.1f, -0.6f, 0.1f}, {0.15f, 0.1f, 0.1f}, {}},
    {"brow", {0, -0.1f, 0}, {0, -0.25f, 0}, {}},
};

// Bulges and dents of age: jowls, bags under the eyes, hollow temples, permanent folds.
constexpr Bulge kAgeBulges[] = {
    {{3.9f, -9.2f, 5.4f}, 0.9f, 0.18f},    {{3.3f, -8.6f, 7.3f}, 0.5f, 0.16f},
    {{2.55f, -8.9f, 7.9f}, 0.45f, -0.16f}, {{2.95f, -7.9f, 8.2f}, 0.35f, -0.12f},
    {{2.4f, -4.9f, 8.9f}, 0.4f, -0.14f},   {{2.85f, -5.9f, 8.7f}, 0.4f, -0.15f},
    {{3.3f, -5.6f, 8.4f}, 0.6f, 0.12f},    {{3.4f, -1.55f, 8.3f}, 0.42f, 0.11f},
    {{2.4f, -1.9f, 8.8f}, 0.4f, -0.12f},   {{3.4f, -2.35f, 8.3f}, 0.45f, -0.10f},
    {{4.8f, -5.6f, 6.6f}, 1.0f, -0.22f},   {{6.7f, 2.6f, 4.2f}, 1.3f, -0.2f},
    {{4.1f, 1.05f, 7.9f}, 0.45f, 0.12f},   {{0.0f, -12.6f, 3.6f}, 1.0f, 0.35f},
};

template <std::size_t N>
void Apply(const Shift (&shifts)[N], float share, std::vector<HeadPrimitive>* primitives) {
  for (const Shift& shift : shifts) {
    for (HeadPrimitive& primitive : *primitives) {
      if (std::string_view(primitive.name) != shift.primitive) continue;
      primitive.a += share * shift.a;
      primitive.b += share * shift.b;
      primitive.r += share * shift.r;
    }
  }
}

// Faces are not symmetric: a smooth warp of 1 to 2 mm.
vec3 Asymmetry(const vec3& p) {
  vec3 w = p;
  w.x += 0.10f * std::exp(-(p.y + 4.0f) * (p.y + 4.0f) / 8.0f);         // the nose leans
  w.y += 0.06f * std::tanh(p.x * 0.6f) * std::exp(-p.y * p.y / 20.0f);  // one eye is higher
  w.y -= 0.07f * std::tanh(p.x * 0.5f) * std::exp(-(p.y + 7.0f) * (p.y + 7.0f) / 6.0f);
  return w;
}

}  // namespace

vec3 EyeCentre(float side) {
  return {side * kEyeCentre.x, kEyeCentre.y - side * 0.057f, kEyeCentre.z};
}

glm::vec3 HeadToModel(const glm::vec3& p) { return (p + kHeadOrigin) * 0.01f; }
glm::vec3 ModelToHead(const glm::vec3& p) { return p * 100.0f - kHeadOrigin; }

HeadShape::HeadShape(const FaceParameters& face)
    : face_(face),
      primitives_(AdultPrimitives().begin(), AdultPrimitives().end()),
      bulges_(AdultBulges().begin(), AdultBulges().end()) {
  Apply(kMan, face.sex, &primitives_);
  const float age = AgeShare(face);
  Apply(kAge, age, &primitives_);
  for (Bulge bulge : kAgeBulges) {
    bulge.height *= age;
    if (age > 0.0f) bulges_.push_back(bulge);
  }
}

float HeadShape::Distance(const glm::vec3& p) const {
  const vec3 w = Asymmetry(p);
  constexpr float kFold = 0.12f;  // |x| is rounded, so there is no crease in the middle
  const vec3 q(std::sqrt(w.x * w.x + kFold * kFold) - kFold, w.y, w.z);
  return PrimitivesDistance(primitives_, q) - BulgesHeight(bulges_, q);
}

glm::vec3 HeadShape::Normal(const glm::vec3& p) const {
  constexpr float kStep = 0.02f;
  // Central differences at the corners of a tetrahedron.
  const vec3 a(1, -1, -1), b(-1, -1, 1), c(-1, 1, -1), e(1, 1, 1);
  return glm::normalize(a * Distance(p + a * kStep) + b * Distance(p + b * kStep) +
                        c * Distance(p + c * kStep) + e * Distance(p + e * kStep));
}

glm::vec3 HeadShape::Cast(const glm::vec3& from, const glm::vec3& direction, float length) const {
  constexpr float kSafety = 0.6f;  // steps are shortened, since the distance is an estimate
  float t = 0.0f;
  for (int i = 0; i < 160 && t < length; ++i) {
    const float d = Distance(from + direction * t);
    if (d < 0.0005f) break;
    t += std::max(d * kSafety, 0.0005f);
  }
  return from + direction * std::min(t, length);
}

const HeadShape& DefaultHead() {
  static const HeadShape head;
  return head;
}

}  // namespace furrow::authoring
