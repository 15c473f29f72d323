// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/generator/head_grid.h"
#include "character/generator/head_mesh.h"
#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kDegrees = 180.0f / std::numbers::pi_v<float>;

// Height of the hairline by azimuth, degrees from the front: forehead, temple, sideburn, ear, nape.
constexpr Knot kHairline[] = {{0, 6.7f},    {18, 6.9f},   {33, 6.8f},  {44, 5.9f},   {52, 4.4f},
                              {58, 3.2f},   {64, 2.2f},   {68, 0.6f},  {71, -1.5f},  {75, -1.6f},
                              {80, 0.7f},   {90, 1.3f},   {104, 1.2f}, {113, -0.6f}, {122, -4.0f},
                              {135, -6.6f}, {160, -7.6f}, {180, -7.8f}};

// Thickness of the hair, centimetres.
float Thickness(const vec3& p, float inside) {
  const float grow = SmoothStep(-0.15f, 2.4f, inside);
  const float top = SmoothStep(5.0f, 10.5f, p.y);
  const float front = SmoothStep(1.0f, 7.0f, p.z) * SmoothStep(4.5f, 8.0f, p.y);
  const float side = 0.35f + 0.25f * SmoothStep(2.0f, -6.0f, p.z);
  const float body = side + 0.9f * top + 0.75f * front;
  const float locks = 0.16f * FractalNoise({p.x * 0.9f, p.y * 0.3f, p.z * 0.35f});
  return -0.12f + grow * (body + 0.12f + locks);
}

}  // namespace

float InsideHairline(const vec3& p) {
  const float azimuth = std::abs(std::atan2(p.x, p.z - 0.0f)) * kDegrees;
  const float ragged = 0.09f * Noise({p.x * 1.7f, p.z * 1.7f, 3.0f});
  return p.y - Interpolate(kHairline, azimuth) + ragged;
}

HeadMesh MakeHair(const HeadShape& shape) {
  const HeadGrid layout(shape);
  HeadMesh hair;
  hair.mesh.name = "hair";
  const int kC = layout.num_columns();
  const int rows = layout.num_rows();
  const vec3 middle(0.0f, 2.0f, -1.0f);
  std::vector<float> inside;
  for (int c = -kC; c <= kC; ++c) {
    for (int r = 0; r < rows; ++r) {
      // The plain grid: openings do not matter here.
      const vec2 place = layout.Plain(c, r);
      HeadVertex info;
      info.part = kHairCap;
      const vec3 skin = layout.Surface(place);
      const vec3 outward =
          glm::normalize(glm::mix(glm::normalize(skin - middle), shape.Normal(skin), 0.4f));
      inside.push_back(InsideHairline(skin));
      info.place = skin + outward * Thickness(skin, inside.back());
      if (std::abs(c) == kC) info.place.x = 0.0f;
      Vertex vertex;
      vertex.position = HeadToModel(info.place);
      vertex.uv = glm::mix(vec2(0.01f), vec2(0.99f), HeadUv(place));
      hair.mesh.vertices.push_back(vertex);
      hair.info.push_back(info);
    }
  }
  const auto index = [&](int c, int r) { return static_cast<std::uint32_t>((c + kC) * rows + r); };
  for (int c = -kC; c < kC; ++c) {
    for (int r = 0; r + 1 < rows; ++r) {
      const std::uint32_t quad[] = {index(c, r), index(c + 1, r), index(c + 1, r + 1),
                                    index(c, r + 1)};
      float best = -100.0f;
      for (const std::uint32_t i : quad) best = std::max(best, inside[i]);
      if (best < -0.35f) continue;
      AddQuad(&hair.mesh, quad[0], quad[1], quad[2], quad[3]);
    }
  }
  FinishSurface(&hair.mesh);
  return hair;
}

}  // namespace furrow::character::generator
