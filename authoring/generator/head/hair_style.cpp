// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/hair_style.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// Height of the hairline by azimuth in degrees from the front: forehead, temple, sideburn, ear,
// nape.
constexpr Knot kHairline[] = {{0, 6.3f},    {14, 6.45f},  {26, 6.5f},  {36, 5.9f},   {44, 4.7f},
                              {51, 3.4f},   {58, 2.4f},   {63, 1.0f},  {68, -1.2f},  {75, -1.6f},
                              {80, -0.3f},  {90, 0.3f},   {104, 0.2f}, {113, -1.0f}, {122, -4.0f},
                              {135, -6.6f}, {160, -7.6f}, {180, -7.8f}};
constexpr float kDegreesPerRadian = 180.0f / std::numbers::pi_v<float>;
constexpr float kPartX = 3.6f;  // x of the parting, on the subject's left
constexpr vec3 kSkull{0.0f, 1.5f, -1.0f};
constexpr float kSkullRadius = 9.3f;
constexpr vec3 kKnotRadii{2.7f, 2.3f, 1.7f};

// How hair grows at a point of the scalp.
struct Style {
  vec3 comb;     // direction, not yet projected onto the scalp
  float length;  // centimetres
  float body;    // largest height of the lock above the scalp, centimetres
  float width;   // half the width, centimetres
};

float WomanShare(const HeadShape& shape) { return 0.5f - 0.5f * shape.face().sex; }

// How far up the head a root is: 0 at the sides, 1 on top.
float Top(const vec3& p) { return Smoothstep(4.2f, 8.0f, p.y); }

Style ShortHair(const vec3& root) {
  const float top = Top(root);
  const float front = Smoothstep(1.5f, 6.5f, root.z) * top;
  const float left = Smoothstep(kPartX - 0.5f, kPartX + 0.5f, root.x);
  const float side = root.x < 0.0f ? -1.0f : 1.0f;
  const vec3 swept = glm::mix(vec3(-0.55f, 0.1f, -0.9f), vec3(0.7f, -0.4f, -0.8f), left);
  const vec3 sides(0.1f * side, -0.75f, -0.75f);
  const float nape = Smoothstep(-1.0f, -7.0f, root.y) * Smoothstep(0.0f, -6.0f, root.z);
  Style style;
  style.comb = glm::mix(sides, swept + vec3(0.0f, 0.6f * front, 0.0f), top);
  style.comb = glm::mix(style.comb, vec3(0.0f, -1.0f, -0.3f), nape);
  style.length = glm::mix(2.8f, 5.4f, top) - 1.0f * nape;
  style.body = glm::mix(0.30f, 0.62f, top) + 0.45f * front - 0.15f * nape;
  style.width = glm::mix(0.36f, 0.50f, top);
  // Sideburns lie flat and point down. Combed back, they would hang over the ear as specks.
  const float burn = Smoothstep(2.0f, 0.4f, root.y) * Smoothstep(-1.0f, 0.5f, root.z);
  style.comb = glm::mix(style.comb, vec3(0.0f, -1.0f, -0.1f), burn);
  style.length = glm::mix(style.length, 1.2f, burn);
  style.body = glm::mix(style.body, 0.06f, burn);
  style.width = glm::mix(style.width, 0.24f, burn);
  return style;
}

vec3 KnotCentre(const HeadShape& shape) {
  const vec3 scalp = shape.Cast({0.0f, 2.6f, -25.0f}, {0.0f, 0.0f, 1.0f}, 30.0f);
  return scalp + vec3(0.0f, 0.0f, -0.8f);
}

// Drawn back into the knot along great circles of the skull.
Style LongHair(const HeadShape& shape, const vec3& root) {
  const vec3 from = glm::normalize(root - kSkull);
  const vec3 to = glm::normalize(KnotCentre(shape) - kSkull);
  const float cosine = glm::dot(from, to);
  const float left = kSkullRadius * std::acos(std::clamp(cosine, -1.0f, 1.0f)) - 1.2f;
  Style style;
  style.comb = to - from * cosine;
  style.length = std::min(9.0f, left);
  style.body = (0.16f + 0.16f * Top(root)) * Smoothstep(-1.0f, 4.0f, left);
  style.width = 0.52f;
  return style;
}

Style StyleAt(const HeadShape& shape, const vec3& root) {
  const float woman = WomanShare(shape);
  const Style a = ShortHair(root);
  const Style b = LongHair(shape, root);
  return {glm::mix(glm::normalize(a.comb), glm::normalize(b.comb), woman),
          glm::mix(a.length, b.length, woman), glm::mix(a.body, b.body, woman),
          glm::mix(a.width, b.width, woman)};
}

}  // namespace

float InsideHairline(const vec3& p) {
  const float azimuth = std::abs(std::atan2(p.x, p.z)) * kDegreesPerRadian;
  const float ragged = 0.16f * SignedNoise({p.x * 1.3f, p.z * 1.3f, 3.0f}) +
                       0.12f * SignedNoise({p.x * 3.7f, p.z * 3.7f, 8.0f});
  return p.y - Interpolate(kHairline, azimuth) + ragged;
}

HairLock GrowLock(const HeadShape& shape, const vec3& root, int number, int sections) {
  const Style style = StyleAt(shape, root);
  const float edge =
      Smoothstep(-0.2f, 1.6f, InsideHairline(root));  // short and flat at the hairline
  const float length =
      style.length * (0.85f + 0.3f * RandomAt(number, 3, 9)) * (0.6f + 0.4f * edge);
  if (length < 0.6f) return {};
  const float body = style.body * (0.55f + 0.55f * RandomAt(number, 4, 9)) * (0.3f + 0.7f * edge);
  // Neighbouring locks lean the same way, with small deviations.
  const vec3 lean =
      0.16f * vec3(SignedNoise(root * 0.45f), SignedNoise(root * 0.45f + 20.0f),
                   SignedNoise(root * 0.45f + 40.0f)) +
      0.12f * (vec3(RandomAt(number, 5, 9), RandomAt(number, 6, 9), RandomAt(number, 7, 9)) - 0.5f);
  HairLock lock;
  lock.width = style.width * (0.8f + 0.4f * RandomAt(number, 8, 9)) * (0.45f + 0.55f * edge);
  const float tip = glm::mix(0.5f, 0.35f, WomanShare(shape));
  vec3 p = root - shape.Normal(root) * 0.05f;
  for (int i = 0; i <= sections; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(sections);
    const vec3 normal = shape.Normal(p);
    if (i > 0) {
      const vec3 comb = StyleAt(shape, p).comb + lean;
      vec3 along = comb - normal * glm::dot(comb, normal);
      if (glm::length(along) < 1e-3f) along = vec3(0, -1, 0);
      p += glm::normalize(along) * (length / static_cast<float>(sections));
      // The lock rises from the scalp and lies down again.
      const float height =
          0.09f + body * Smoothstep(0.0f, 0.4f, t) * glm::mix(1.0f, tip, Smoothstep(0.5f, 1.0f, t));
      p += shape.Normal(p) * (height - shape.Distance(p));
    }
    lock.path.push_back(p);
    lock.out.push_back(shape.Normal(p));
  }
  return lock;
}

std::vector<HairLock> WindKnot(const HeadShape& shape, int sections) {
  constexpr int kRings = 7;
  constexpr int kAround = 12;
  constexpr float kArc = 1.7f;  // radians that a lock winds around the knot
  std::vector<HairLock> locks;
  const float size = Smoothstep(0.3f, 0.8f, WomanShare(shape));
  if (size <= 0.0f) return locks;
  const vec3 centre = KnotCentre(shape);
  for (int ring = 0; ring < kRings; ++ring) {
    for (int i = 0; i < kAround; ++i) {
      const int number = ring * kAround + i;
      HairLock lock;
      lock.width = size * (0.42f + 0.12f * RandomAt(number, 1, 21));
      const float out = size * (1.0f + 0.05f * RandomAt(number, 2, 21));
      const float start = (static_cast<float>(i) + RandomAt(number, 3, 21)) / kAround;
      for (int s = 0; s <= sections; ++s) {
        const float t = static_cast<float>(s) / static_cast<float>(sections);
        const float turn = 2.0f * std::numbers::pi_v<float> * start + kArc * t;
        // Each lock winds from the rim of the knot inward.
        const float tilt = 0.22f + 0.235f * (static_cast<float>(ring) + 0.7f * (0.5f - t));
        const vec3 d(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                     -std::cos(tilt));
        lock.path.push_back(centre + d * kKnotRadii * out);
        lock.out.push_back(glm::normalize(d / kKnotRadii));
      }
      locks.push_back(std::move(lock));
    }
  }
  return locks;
}

}  // namespace furrow::authoring
