// SPDX-License-Identifier: Apache-2.0
#include "character/generator/hair_style.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/generator/head_mesh.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec3;

constexpr float kPartX = 3.6f;  // the parting, on the subject's left

// What a place of the scalp grows.
struct Style {
  vec3 comb;     // direction, not yet along the scalp
  float length;  // centimetres
  float body;    // how far the lock stands off at its highest
};

// How far up the head a root is: 0 at the sides, 1 on top.
float Top(const vec3& p) { return SmoothStep(4.6f, 8.2f, p.y); }

Style ShortHair(const vec3& root) {
  const float top = Top(root);
  const float front = SmoothStep(1.5f, 6.5f, root.z) * top;
  const float left = SmoothStep(kPartX - 0.4f, kPartX + 0.4f, root.x);
  const float side = root.x < 0.0f ? -1.0f : 1.0f;
  const vec3 swept = glm::mix(vec3(-0.75f, 0.1f, -0.75f), vec3(0.9f, -0.5f, -0.6f), left);
  const vec3 sides(0.12f * side, -0.75f, -0.7f);
  const float nape = SmoothStep(-1.0f, -7.0f, root.y) * SmoothStep(0.0f, -6.0f, root.z);
  Style style;
  style.comb = glm::mix(sides, swept + vec3(0.0f, 0.85f * front, 0.0f), top);
  style.length = glm::mix(2.9f, 5.6f, top) - 1.0f * nape;
  style.body = glm::mix(0.42f, 0.85f, top) + 0.55f * front - 0.2f * nape;
  return style;
}

// Swept back from the face, down to the nape.
Style LongHair(const vec3& root) {
  const float left = SmoothStep(kPartX - 0.5f, kPartX + 0.5f, root.x);
  const float top = Top(root);
  const float front = SmoothStep(0.0f, 4.5f, root.z);
  const float side = root.x < 0.0f ? -1.0f : 1.0f;
  const vec3 from_part = glm::mix(vec3(-0.8f, 0.0f, -0.6f), vec3(0.7f, -0.1f, -0.7f), left);
  const vec3 back(0.25f * side, 0.1f, -1.0f);
  Style style;
  style.comb = glm::mix(vec3(0.1f * side, -0.8f, -0.6f), glm::mix(from_part, back, 0.5f * front),
                        std::max(top, front));
  style.length = std::clamp(root.y + 6.0f, 2.5f, 12.0f);
  style.body = 0.75f + 0.45f * top + 0.35f * front * top;
  return style;
}

}  // namespace

HairLock GrowLock(const HeadShape& shape, const vec3& root, int number, int sections) {
  const float woman = 0.5f - 0.5f * shape.face().sex;
  const Style a = ShortHair(root);
  const Style b = LongHair(root);
  const float vary = 0.75f + 0.5f * Hash(number, 3, 9);
  const float edge =
      SmoothStep(-0.2f, 1.6f, InsideHairline(root));  // short and flat at the hairline
  const float length = glm::mix(a.length, b.length, woman) * vary * (0.55f + 0.45f * edge);
  const float body = glm::mix(a.body, b.body, woman) * (0.55f + 0.75f * Hash(number, 4, 9)) *
                     (0.35f + 0.65f * edge);
  const vec3 stray(0.35f * (Hash(number, 5, 9) - 0.5f), 0.35f * (Hash(number, 6, 9) - 0.5f),
                   0.35f * (Hash(number, 7, 9) - 0.5f));
  HairLock lock;
  lock.width = (0.20f + 0.14f * Hash(number, 8, 9)) * (0.7f + 0.3f * edge) * (1.0f + 0.9f * woman);
  vec3 p = root - shape.Normal(root) * 0.05f;
  lock.path.push_back(p);
  const float step = length / static_cast<float>(sections);
  for (int i = 1; i <= sections; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(sections);
    const vec3 normal = shape.Normal(p);
    // Gravity takes what is long.
    const float fall =
        SmoothStep(0.15f, 0.7f, t) * SmoothStep(7.5f, 11.0f, length) * SmoothStep(2.0f, -1.5f, p.z);
    const vec3 comb = glm::mix(glm::normalize(glm::mix(a.comb, b.comb, woman) + stray),
                               vec3(0.0f, -1.0f, -0.05f), fall);
    vec3 along = comb - normal * glm::dot(comb, normal) * (1.0f - 0.6f * fall);
    if (glm::length(along) < 1e-3f) along = vec3(0, -1, 0);
    p += glm::normalize(along) * step;
    // It rises from the scalp, and short hair comes back to it.
    const float tip = glm::mix(0.45f, 0.9f, woman);
    const float height =
        body * SmoothStep(0.0f, 0.35f, t) * glm::mix(1.0f, tip, SmoothStep(0.5f, 1.0f, t));
    const float over = shape.Distance(p);
    if (over < height || fall < 0.5f) p += shape.Normal(p) * (height - over);
    lock.path.push_back(p);
  }
  return lock;
}

}  // namespace furrow::character::generator
