// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/teeth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <glm/common.hpp>

#include "authoring/paint/canvas.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kSteps = 72;      // columns on either side of the middle
constexpr float kStep = 0.06f;  // arc length per column, centimetres
// Heights above the biting edge, centimetres: the crown, then the gum.
constexpr float kHeights[] = {0.0f, 0.06f, 0.25f, 0.55f, 0.8f, 0.92f, 1.05f, 1.5f};
constexpr int kRows = static_cast<int>(std::size(kHeights));
constexpr float kTop = kHeights[kRows - 1];

// Half widths of the teeth from the middle outward, centimetres: incisors, canine, premolars,
// molars.
constexpr float kUpperTeeth[] = {0.43f, 0.33f, 0.38f, 0.35f, 0.34f, 0.50f, 0.48f};
constexpr float kLowerTeeth[] = {0.27f, 0.29f, 0.34f, 0.35f, 0.35f, 0.52f, 0.50f};

// The tooth at arc length `s` from the middle, and the position across it, [-1, 1].
struct OnTooth {
  int tooth;
  float across;
};

OnTooth ToothAt(float s, bool upper) {
  float start = 0.0f;
  for (int i = 0; i < 7; ++i) {
    const float half = upper ? kUpperTeeth[i] : kLowerTeeth[i];
    if (s < start + 2.0f * half || i == 6) return {i, (s - start) / half - 1.0f};
    start += 2.0f * half;
  }
  return {6, 1.0f};
}

// A point of the row. `s`: arc length (negative on the subject's right); `h`: height above the
// edge.
vec3 PlaceOf(const ToothArch& arch, float s, float h) {
  // The arch as an ellipse by its angle. Arc length grows faster than the angle toward the sides.
  const float angle = std::atan2(s / arch.half_width, 1.0f - 0.055f * s * s);
  const auto [tooth, across] = ToothAt(std::abs(s), arch.upper);
  const float round = 1.0f - std::pow(std::abs(across), 3.5f);
  const bool canine = tooth == 2;
  const float gum = glm::smoothstep(0.80f, 0.95f, h + 0.12f * (1.0f - round));
  const float crown = 0.085f * round * (1.0f - gum) - (h < 0.05f ? 0.12f : 0.0f);
  const float out = crown + 0.05f * gum - 0.05f * (1.0f - glm::smoothstep(0.0f, 0.6f, h));
  const float worn = (canine ? -0.05f * (1.0f - std::abs(across)) : 0.05f * (1.0f - round)) +
                     (tooth == 1 ? 0.06f : 0.0f);
  const float lift = h + worn * (1.0f - glm::smoothstep(0.0f, 0.5f, h));
  const float back = arch.half_depth - (arch.half_depth + out) * std::cos(angle);
  return arch.front + vec3((arch.half_width + out) * std::sin(angle),
                           (arch.upper ? lift : -lift) + arch.rise * back / arch.half_depth, -back);
}

// The colour at a point of the row: enamel, gums, or the gap between two teeth.
vec3 ToothColour(float s, float h, bool upper, float age) {
  const vec3 enamel =
      glm::mix(vec3(0.95f, 0.91f, 0.83f), vec3(0.82f, 0.72f, 0.55f), 0.06f + 0.6f * age);
  vec3 colour =
      glm::mix(enamel, enamel * vec3(0.96f, 0.89f, 0.78f), glm::smoothstep(0.3f, 0.9f, h));
  // The edge lets light through and shows the dark mouth.
  colour = glm::mix(colour, vec3(0.72f, 0.73f, 0.72f), 0.45f * glm::smoothstep(0.14f, 0.0f, h));
  const auto [tooth, place] = ToothAt(std::abs(s), upper);
  const float across = std::abs(place);
  colour *= tooth == 2 ? vec3(0.97f, 0.93f, 0.85f) : vec3(1.0f);  // canines are yellower
  colour *= 1.0f - 0.5f * glm::smoothstep(0.84f, 1.0f, across);
  const float scallop = 0.10f * across * across - 0.08f * age;  // gums dip between the teeth
  colour = glm::mix(colour, vec3(0.62f, 0.30f, 0.29f), glm::smoothstep(0.86f, 0.96f, h + scallop));
  // Back teeth are darker, since little light passes between the lips.
  return colour * glm::mix(1.0f, 0.4f, glm::smoothstep(1.2f, 3.6f, std::abs(s)));
}

}  // namespace

ToothRow MakeToothRow(const ToothArch& arch) {
  ToothRow row;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const float u = 0.01f + 0.98f * (0.5f + 0.5f * static_cast<float>(i) / kSteps);
    for (const float h : kHeights) {
      row.positions.push_back(PlaceOf(arch, kStep * static_cast<float>(i), h));
      row.uvs.emplace_back(u, arch.upper ? 0.49f - 0.48f * h / kTop : 0.51f + 0.48f * h / kTop);
    }
  }
  for (std::uint32_t i = 0; i < 2 * kSteps; ++i) {
    for (std::uint32_t r = 0; r + 1 < kRows; ++r) {
      const std::uint32_t a = i * kRows + r, b = a + kRows;
      if (arch.upper) {
        row.quads.insert(row.quads.end(), {a, b, b + 1, a + 1});
      } else {
        row.quads.insert(row.quads.end(), {a + 1, b + 1, b, a});
      }
    }
  }
  return row;
}

character::Picture PaintTeeth(float age, int size) {
  character::Picture picture = BlankPicture("teeth_colour", size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / static_cast<float>(size);
      const float s = (uv.x - 0.5f) / 0.49f * kStep * kSteps;
      const float h = kTop * std::max(std::abs(uv.y - 0.5f) - 0.01f, 0.0f) / 0.48f;
      SetTexel(&picture, x, y, glm::vec4(ToothColour(s, h, uv.y < 0.5f, age), 1.0f));
    }
  }
  return picture;
}

}  // namespace furrow::authoring
