// SPDX-License-Identifier: Apache-2.0
#include "character/generator/ear_mesh.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadii[] = {0.0f,  0.18f, 0.34f, 0.46f, 0.56f, 0.65f,
                            0.73f, 0.80f, 0.87f, 0.93f, 0.98f, 1.0f};
constexpr int kFrontRings = static_cast<int>(std::size(kRadii));
constexpr int kBackRings = 3;

// The ear's plane: s toward the back of the head, t up; phi = 0 is back, counter-clockwise.
vec2 Outline(float phi) {
  const float s = std::cos(phi);
  const float t = std::sin(phi);
  const float lobe = SmoothStep(0.2f, 1.0f, -t);
  const float width = (1.75f - 0.45f * lobe) * (s < 0.0f ? 0.9f : 1.0f);
  return {s * width + 0.12f * t - 0.35f * lobe, t * 3.15f};
}

// Height over the ear's plane, centimetres.
float Relief(float rho, float phi) {
  const float s = std::cos(phi);
  const float t = std::sin(phi);
  const float rim = SmoothStep(-0.75f, -0.25f, t) * (1.0f - SmoothStep(0.6f, 0.95f, -s));
  const float lobe = SmoothStep(0.45f, 0.9f, -t);
  const float helix = 0.40f * Bump(rho - 0.91f, 0.08f) * rim;
  const float anti = 0.36f * Bump(rho - 0.6f, 0.12f) * SmoothStep(-0.35f, 0.3f, s) * (1.0f - lobe);
  const vec2 p = vec2(rho * s, rho * t);
  const float concha =
      -0.5f * Bump(glm::length((p - vec2(-0.18f, -0.12f)) / vec2(0.85f, 0.75f)), 0.42f);
  const float tragus = 0.42f * Bump(glm::length(p - vec2(-0.78f, -0.16f)), 0.2f);
  const float swell = 0.25f * lobe * (1.0f - rho * rho);
  const float root =
      -0.6f * SmoothStep(0.72f, 1.0f, -rho * s);  // the front edge sinks into the head
  return helix + anti + concha + tragus + swell + root - 0.12f * SmoothStep(0.95f, 1.0f, rho);
}

// Where the ear sits: its middle and its plane's axes, leaning back, standing off the head.
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

// Ring `ring` of the ear: the front side from its middle to the rim, then the back of it.
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
    Vertex vertex;
    vertex.position = HeadToModel(info.place);
    vertex.uv = {(side > 0.0f ? 0.25f : 0.75f) + 2.3f * reach * std::cos(phi),
                 0.932f - reach * std::sin(phi)};
    head->mesh.vertices.push_back(vertex);
    head->info.push_back(info);
  }
}

}  // namespace

void AddEar(float side, int level, HeadMesh* head) {
  const int segments = level == kCoarsestLevel ? 14 : 32;
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
      // Backward, up, outward: right-handed on the left side alone.
      if (side > 0.0f) {
        AddQuad(&head->mesh, a, b, c, d);
      } else {
        AddQuad(&head->mesh, d, c, b, a);
      }
    }
  }
}

}  // namespace furrow::character::generator
