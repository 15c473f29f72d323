// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/mesh/solid.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

// Catmull-Rom between b and c for uneven steps. Slopes are divided differences.
float Cubic(const float (&at)[4], float a, float b, float c, float d, float x) {
  const float span = at[2] - at[1];
  const float slope_b = (c - a) / (at[2] - at[0]) * span;
  const float slope_c = (d - b) / (at[3] - at[1]) * span;
  const float t = (x - at[1]) / span;
  const float t2 = t * t;
  const float t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * b + (t3 - 2 * t2 + t) * slope_b + (3 * t2 - 2 * t3) * c +
         (t3 - t2) * slope_c;
}

}  // namespace

// Quilez's polynomial smooth minimum: exact where the distances differ by more than `radius`.
float SmoothMin(float a, float b, float radius) {
  const float h = std::max(radius - std::abs(a - b), 0.0f) / radius;
  return std::min(a, b) - h * h * radius * 0.25f;
}

float RodDistance(const vec3& p, const vec3& a, const vec3& b, float radius_a, float radius_b) {
  const vec3 along = b - a;
  const float t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0f, 1.0f);
  return glm::distance(p, a + along * t) - (radius_a + (radius_b - radius_a) * t);
}

Section SectionAt(std::span<const Section> sections, float height) {
  const bool falling = sections.front().height > sections.back().height;
  const auto before = [&](float a, float b) { return falling ? a > b : a < b; };
  if (!before(sections.front().height, height)) return sections.front();
  if (!before(height, sections.back().height)) return sections.back();
  std::size_t i = 1;
  while (before(sections[i].height, height)) ++i;
  const Section& b = sections[i - 1];
  const Section& c = sections[i];
  const Section& a = i >= 2 ? sections[i - 2] : b;
  const Section& d = i + 1 < sections.size() ? sections[i + 1] : c;
  const float at[4] = {a.height, b.height, c.height, d.height};
  const auto mix = [&](float Section::*m) { return Cubic(at, a.*m, b.*m, c.*m, d.*m, height); };
  return {height,           mix(&Section::half_width), mix(&Section::front), mix(&Section::back),
          mix(&Section::x), mix(&Section::z)};
}

float TrunkDistance(const vec3& p, std::span<const Section> sections, float power) {
  const Section s = SectionAt(sections, p.y);
  const glm::vec2 q(p.x - s.x, p.z - s.z);
  const float depth = q.y > 0.0f ? s.front : s.back;
  // A superellipse: r is 1 on its outline. The distance is measured along the ray from the centre,
  // and near the centre, where the ray has no direction, by the smaller half axis.
  const float r = std::pow(
      std::pow(std::abs(q.x) / s.half_width, power) + std::pow(std::abs(q.y) / depth, power),
      1.0f / power);
  const float across =
      r > 1e-3f ? glm::length(q) * (1.0f - 1.0f / r) : -std::min(s.half_width, depth);
  const auto [low, high] = std::minmax(sections.front().height, sections.back().height);
  const float beyond = std::max(low - p.y, p.y - high);
  if (beyond <= 0.0f) return across;
  const float outside = std::max(across, 0.0f);
  return across < 0.0f && beyond < -across ? std::max(across, beyond)
                                           : std::sqrt(outside * outside + beyond * beyond);
}

vec3 SolidNormal(const Solid& solid, const vec3& p) {
  constexpr float kStep = 5e-4f;
  const auto slope = [&](const vec3& axis) {
    return solid(p + axis * kStep) - solid(p - axis * kStep);
  };
  const vec3 gradient(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1}));
  const float length = glm::length(gradient);
  return length > 0.0f ? gradient / length : vec3(0, 1, 0);
}

// Newton steps, slightly damped, because the gradient's length is only about 1.
vec3 OnSurface(const Solid& solid, const vec3& p) {
  vec3 at = p;
  for (int i = 0; i < 4; ++i) at -= SolidNormal(solid, at) * (0.9f * solid(at));
  return at;
}

// Sphere tracing with a safety factor, because distances are approximate, and then bisection.
vec3 CastOut(const Solid& solid, const vec3& from, const vec3& direction, float reach) {
  constexpr float kLeast = 5e-4f;
  float inside = 0.0f;
  float t = 0.0f;
  while (t < reach) {
    const float d = solid(from + direction * t);
    if (d >= 0.0f) break;
    inside = t;
    t += std::max(-0.7f * d, kLeast);
  }
  float outside = std::min(t, reach);
  for (int i = 0; i < 16; ++i) {
    const float middle = 0.5f * (inside + outside);
    (solid(from + direction * middle) < 0.0f ? inside : outside) = middle;
  }
  return from + direction * outside;
}

}  // namespace furrow::authoring
