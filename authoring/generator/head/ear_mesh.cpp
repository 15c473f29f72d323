// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/ear_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kRadii[] = {0.0f,  0.16f, 0.28f, 0.38f, 0.46f, 0.53f, 0.59f, 0.65f,
                            0.71f, 0.77f, 0.82f, 0.87f, 0.92f, 0.96f, 0.99f, 1.0f};
constexpr int kFrontRings = static_cast<int>(std::size(kRadii));
constexpr int kBackRings = 3;

// The outline in the ear's plane: s toward the back of the head, t up. phi is 0 at the back and
// grows counter-clockwise.
vec2 Outline(float phi) {
  const float s = std::cos(phi);
  const float t = std::sin(phi);
  const float lobe = Smoothstep(0.2f, 1.0f, -t);
  const float width = (1.75f - 0.45f * lobe) * (s < 0.0f ? 0.9f : 1.0f);
  return {s * width + 0.12f * t - 0.35f * lobe, t * 3.15f};
}

// The height above the ear's plane, centimetres. Positions are in the unit disc: x back, y up.
float Relief(float rho, float phi) {
  const vec2 p = rho * vec2(std::cos(phi), std::sin(phi));
  const auto ridge = [&p](const vec2& a, const vec2& b, float width) {
    const float t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0f, 1.0f);
    return Bump(glm::distance(p, a + t * (b - a)), width);
  };
  const float back = Smoothstep(-0.55f, 0.1f, p.x);
  const float lobe = Smoothstep(-0.35f, -0.85f, p.y);
  const float above = 1.0f - lobe;
  // The rim curls from its root in front over the top down to the lobe, with a groove inside it.
  const float rim =
      above * (1.0f - 0.85f * Smoothstep(0.55f, 0.9f, -p.x) * Smoothstep(0.5f, 0, p.y));
  const float helix = (0.42f * Bump(rho - 0.89f, 0.095f) - 0.14f * Bump(rho - 0.72f, 0.09f)) * rim;
  const float crus = 0.26f * ridge({-0.85f, 0.12f}, {-0.28f, 0.02f}, 0.09f);
  // The inner ridge: an arc that forks at the top.
  const float arc =
      Bump(glm::length((p - vec2(-0.16f, -0.14f)) / vec2(0.80f, 0.62f)) - 1.0f, 0.13f);
  const float anti = 0.40f * arc * back * Smoothstep(0.40f, 0.15f, p.y) * above;
  const float forks = 0.30f * std::max(ridge({0.45f, 0.22f}, {0.20f, 0.66f}, 0.10f),
                                       ridge({0.40f, 0.24f}, {-0.32f, 0.50f}, 0.09f));
  const float bowl =
      -0.62f * Smoothstep(1.0f, 0.45f, glm::length((p - vec2(-0.2f, -0.14f)) / vec2(0.56f, 0.5f)));
  const float tragus = 0.55f * Bump(glm::length(p - vec2(-0.74f, -0.20f)), 0.22f);
  const float swell = 0.22f * lobe * (1.0f - rho * rho);
  const float root = -0.6f * Smoothstep(0.72f, 1.0f, -p.x);  // the front sinks into the head
  return helix + crus + std::max(anti, forks) + bowl + tragus + swell + root -
         0.14f * Smoothstep(0.95f, 1.0f, rho);
}

// The frame of an ear: its centre and axes. Ears lean back and stand off the head.
struct Seat {
  vec3 centre;
  vec3 back;
  vec3 up;
  vec3 out;
};

Seat SeatOf(float side) {
  const float lean = 12.0f * kPi / 180.0f;
  const float stand = 26.0f * kPi / 180.0f;
  const vec3 back = vec3(side * std::sin(stand), 0.0f, -std::cos(stand));
  const vec3 up(0.0f, 1.0f, 0.0f);
  return {vec3(side * 8.0f, -1.35f, -1.35f), back * std::cos(lean) - up * std::sin(lean),
          up * std::cos(lean) + back * std::sin(lean),
          vec3(side * std::cos(stand), 0.0f, std::sin(stand))};
}

// Adds a ring of the ear. Rings run over the front from the middle to the rim, then over the back.
void AddRing(float side, int ring, int segments, HeadMesh* head) {
  const Seat seat = SeatOf(side);
  const bool behind = ring >= kFrontRings;
  const float step = static_cast<float>(ring - kFrontRings + 1);
  const float rho = behind ? 1.0f - 0.09f * step * step : kRadii[ring];
  const float reach = (behind ? 0.80f + 0.065f * step : 0.80f * rho) * 0.062f;
  for (int k = 0; k <= segments; ++k) {
    const float phi = 2.0f * kPi * static_cast<float>(k % segments) / static_cast<float>(segments);
    const vec2 st = Outline(phi) * rho;
    const float height = behind ? Relief(1.0f, phi) - 0.34f * step : Relief(rho, phi);
    HeadVertex info;
    info.part = kEar;
    info.place = seat.centre + seat.back * st.x + seat.up * st.y + seat.out * height;
    character::Vertex vertex;
    vertex.position = HeadToModel(info.place);
    vertex.uv = {(side > 0.0f ? 0.25f : 0.75f) + 2.3f * reach * std::cos(phi),
                 0.932f - reach * std::sin(phi)};
    head->mesh.vertices.push_back(vertex);
    head->info.push_back(info);
  }
}

}  // namespace

void AddEar(float side, int level, HeadMesh* head) {
  const int segments = level == kCoarsestLevel ? 14 : 40;
  const int step = level == kCoarsestLevel ? 2 : 1;
  const int last = kFrontRings + kBackRings - 1;
  int rings = 0;
  const auto first = static_cast<std::uint32_t>(head->mesh.vertices.size());
  for (int i = 0; i < last; i += step, ++rings) AddRing(side, i, segments, head);
  AddRing(side, last, segments, head);
  const auto index = [&](int ring, int k) {
    return first + static_cast<std::uint32_t>(ring * (segments + 1) + k);
  };
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      const std::uint32_t a = index(i, k), b = index(i + 1, k), c = index(i + 1, k + 1),
                          d = index(i, k + 1);
      // The axes (back, up, out) are right-handed only on the left side.
      if (side > 0.0f) {
        AddQuad(&head->mesh, a, b, c, d);
      } else {
        AddQuad(&head->mesh, d, c, b, a);
      }
    }
  }
}

}  // namespace furrow::authoring
