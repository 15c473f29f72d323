// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/generator/hair_style.h"
#include "character/generator/head_grid.h"
#include "character/generator/head_mesh.h"
#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"
#include "character/paint/tangents.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kDegrees = 180.0f / std::numbers::pi_v<float>;
constexpr int kSections = 6;        // of a lock, root to tip
constexpr int kCells = 40;          // locks along a side of the texture
constexpr float kCapTop = 0.72f;    // locks above this v, the cap below
constexpr float kLockArea = 0.40f;  // square centimetres of scalp a lock grows from

// Height of the hairline by azimuth, degrees from the front: forehead, temple, sideburn, ear, nape.
constexpr Knot kHairline[] = {{0, 6.3f},    {14, 6.45f},  {26, 6.5f},  {36, 5.9f},   {44, 4.7f},
                              {51, 3.4f},   {58, 2.4f},   {63, 1.0f},  {68, -1.2f},  {75, -1.6f},
                              {80, 0.7f},   {90, 1.3f},   {104, 1.2f}, {113, -0.6f}, {122, -4.0f},
                              {135, -6.6f}, {160, -7.6f}, {180, -7.8f}};

std::uint32_t Add(HeadMesh* hair, const vec3& place, const vec2& uv) {
  HeadVertex info;
  info.part = kHairCap;
  info.place = place;
  Vertex vertex;
  vertex.position = HeadToModel(place);
  vertex.uv = uv;
  hair->mesh.vertices.push_back(vertex);
  hair->info.push_back(info);
  return static_cast<std::uint32_t>(hair->mesh.vertices.size() - 1);
}

// The shade below the locks: a thin cap, so that no skin is seen between them.
void AddCap(const HeadGrid& grid, HeadMesh* hair) {
  const int last = grid.num_columns();
  const int rows = grid.num_rows();
  const auto at = [&](int c, int r) { return static_cast<std::size_t>((c + last) * rows + r); };
  std::vector<vec3> skin(at(last, rows - 1) + 1);
  for (int c = -last; c <= last; ++c) {
    for (int r = 0; r < rows; ++r) skin[at(c, r)] = grid.Surface(grid.Plain(c, r));
  }
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> added(skin.size(), kNone);
  const auto vertex = [&](int c, int r) {
    std::uint32_t& index = added[at(c, r)];
    if (index != kNone) return index;
    vec3 place = skin[at(c, r)];
    const float inside = InsideHairline(place);
    place += grid.shape().Normal(place) * (-0.15f + 0.32f * SmoothStep(0.1f, 1.4f, inside));
    if (std::abs(c) == last) place.x = 0.0f;
    const vec2 uv = glm::mix(vec2(0.01f), vec2(0.99f), HeadUv(grid.Plain(c, r)));
    return index = Add(hair, place, {uv.x, kCapTop + 0.01f + (0.98f - kCapTop) * uv.y});
  };
  for (int c = -last; c < last; ++c) {
    for (int r = 0; r + 1 < rows; ++r) {
      const float best =
          std::max({InsideHairline(skin[at(c, r)]), InsideHairline(skin[at(c + 1, r)]),
                    InsideHairline(skin[at(c + 1, r + 1)]), InsideHairline(skin[at(c, r + 1)])});
      if (best < 0.0f) continue;
      AddQuad(&hair->mesh, vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1), vertex(c, r + 1));
    }
  }
}

// One lock: a ribbon, raised along its middle, that follows the path and ends in a point.
void AddLock(const HeadShape& shape, const HairLock& lock, int number, HeadMesh* hair) {
  const vec2 cell(static_cast<float>(number % kCells) / kCells,
                  kCapTop * static_cast<float>(number / kCells) / kCells);
  const vec2 size(0.92f / kCells, 0.92f * kCapTop / kCells);
  const auto first = static_cast<std::uint32_t>(hair->mesh.vertices.size());
  const int count = static_cast<int>(lock.path.size());
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const vec3 along =
        glm::normalize(lock.path[std::min(i + 1, count - 1)] - lock.path[std::max(i - 1, 0)]);
    const vec3 normal = shape.Normal(lock.path[i]);
    const vec3 across = glm::normalize(glm::cross(normal, along));
    const vec3 up = glm::normalize(glm::cross(along, across));
    // Full within a fifth of its length, then to a point.
    const float width =
        lock.width * (0.55f + 0.45f * SmoothStep(0.0f, 0.2f, t)) * (1.0f - 0.94f * t * t * t);
    for (const float s : {-1.0f, 0.0f, 1.0f}) {
      const vec3 place = lock.path[i] + across * (s * width) - up * (0.35f * width * s * s);
      Add(hair, place, cell + size * vec2(0.5f + 0.5f * s, t));
    }
  }
  for (int i = 0; i + 1 < count; ++i) {
    for (std::uint32_t s = 0; s < 2; ++s) {
      const std::uint32_t a = first + 3 * static_cast<std::uint32_t>(i) + s;
      AddQuad(&hair->mesh, a, a + 3, a + 4, a + 1);
    }
  }
}

// Locks are lit as the hair's whole mass is: each by itself would look like a scale.
void SmoothShading(const HeadShape& shape, HeadMesh* hair) {
  for (std::size_t i = 0; i < hair->info.size(); ++i) {
    vec3& normal = hair->mesh.vertices[i].normal;
    const vec3 mass = shape.Normal(hair->info[i].place);
    if (glm::dot(normal, mass) < 0.0f) normal = -normal;
    normal = glm::normalize(glm::mix(normal, mass, 0.55f));
  }
  paint::ComputeTangents(hair->mesh.vertices, hair->mesh.indices);
}

// The area of a cell of the grid, square centimetres.
float CellArea(const HeadGrid& grid, int c, int r) {
  const vec3 a = grid.Surface(grid.Plain(c, r)), b = grid.Surface(grid.Plain(c + 1, r));
  const vec3 d = grid.Surface(grid.Plain(c, r + 1)), e = grid.Surface(grid.Plain(c + 1, r + 1));
  return 0.5f * (glm::length(glm::cross(b - a, d - a)) + glm::length(glm::cross(e - b, e - d)));
}

}  // namespace

float InsideHairline(const vec3& p) {
  const float azimuth = std::abs(std::atan2(p.x, p.z)) * kDegrees;
  const float ragged =
      0.16f * Noise({p.x * 1.3f, p.z * 1.3f, 3.0f}) + 0.12f * Noise({p.x * 3.7f, p.z * 3.7f, 8.0f});
  return p.y - Interpolate(kHairline, azimuth) + ragged;
}

HeadMesh MakeHair(const HeadShape& shape) {
  const HeadGrid grid(shape);
  HeadMesh hair;
  hair.mesh.name = "hair";
  AddCap(grid, &hair);
  int number = 0;
  float due = 0.0f;  // locks that the area so far has earned
  for (int c = -grid.num_columns(); c < grid.num_columns(); ++c) {
    for (int r = 0; r + 1 < grid.num_rows(); ++r) {
      const vec3 middle = grid.Surface(0.5f * (grid.Plain(c, r) + grid.Plain(c + 1, r + 1)));
      const float inside = InsideHairline(middle);
      if (inside < -0.25f) continue;
      // Denser where the hairline shows.
      due += CellArea(grid, c, r) / (kLockArea * (inside < 0.9f ? 0.55f : 1.0f));
      for (; due >= 1.0f && number < kCells * kCells; due -= 1.0f, ++number) {
        const vec2 jitter(Hash(number, 1, 7), Hash(number, 2, 7));
        const vec3 root =
            grid.Surface(glm::mix(grid.Plain(c, r), grid.Plain(c + 1, r + 1), jitter));
        if (InsideHairline(root) < -0.1f) continue;
        AddLock(shape, GrowLock(shape, root, number, kSections), number, &hair);
      }
    }
  }
  FinishSurface(&hair.mesh);
  SmoothShading(shape, &hair);
  return hair;
}

}  // namespace furrow::character::generator
