// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/mesh/mesh_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "character/mesh/tangents.h"
#include "wrinkle/drivers/strain/strain.h"

namespace furrow::character::generator {
namespace {

constexpr float kSamePlace = 1e-6f;  // metres

void AddTriangle(Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const glm::vec3& pa = mesh->vertices[a].position;
  const glm::vec3& pb = mesh->vertices[b].position;
  const glm::vec3& pc = mesh->vertices[c].position;
  if (!wrinkle::MakeRestTriangle(pa, pb, pc, {})) return;  // no area
  mesh->indices.insert(mesh->indices.end(), {a, b, c});
}

std::array<long, 3> Place(const glm::vec3& p) {
  return {std::lround(p.x / kSamePlace), std::lround(p.y / kSamePlace),
          std::lround(p.z / kSamePlace)};
}

}  // namespace

void AddQuad(Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const auto& v = mesh->vertices;
  // Along the shorter diagonal: it follows the form better.
  if (glm::distance(v[a].position, v[c].position) <= glm::distance(v[b].position, v[d].position)) {
    AddTriangle(mesh, a, b, c);
    AddTriangle(mesh, a, c, d);
  } else {
    AddTriangle(mesh, a, b, d);
    AddTriangle(mesh, b, c, d);
  }
}

void FinishSurface(Mesh* mesh) {
  std::map<std::array<long, 3>, glm::vec3> normals;
  for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
    const Vertex& a = mesh->vertices[mesh->indices[i]];
    const Vertex& b = mesh->vertices[mesh->indices[i + 1]];
    const Vertex& c = mesh->vertices[mesh->indices[i + 2]];
    const glm::vec3 n = glm::cross(b.position - a.position, c.position - a.position);
    for (int k = 0; k < 3; ++k) normals[Place(mesh->vertices[mesh->indices[i + k]].position)] += n;
  }
  for (Vertex& vertex : mesh->vertices) {
    const glm::vec3 n = normals[Place(vertex.position)];
    vertex.normal = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0, 0, 1);
  }
  paint::ComputeTangents(mesh->vertices, mesh->indices);
}

float Interpolate(std::span<const Knot> knots, float x) {
  if (x <= knots.front().first) return knots.front().second;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (x > knots[i].first) continue;
    const auto& [x0, y0] = knots[i - 1];
    const auto& [x1, y1] = knots[i];
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
  }
  return knots.back().second;
}

float SmoothStep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

float Bump(float x, float width) { return std::exp(-(x / width) * (x / width)); }

float Hash(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  h ^= h >> 16;
  return static_cast<float>(h >> 8) / 16777216.0f;
}

float Noise(const glm::vec3& p) {
  const glm::vec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const glm::vec3 f = p - cell;
  const glm::vec3 s = f * f * (3.0f - 2.0f * f);
  const auto corner = [&](int x, int y, int z) {
    return Hash(static_cast<int>(cell.x) + x, static_cast<int>(cell.y) + y,
                static_cast<int>(cell.z) + z);
  };
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float low = mix(mix(corner(0, 0, 0), corner(1, 0, 0), s.x),
                        mix(corner(0, 1, 0), corner(1, 1, 0), s.x), s.y);
  const float high = mix(mix(corner(0, 0, 1), corner(1, 0, 1), s.x),
                         mix(corner(0, 1, 1), corner(1, 1, 1), s.x), s.y);
  return mix(low, high, s.z) * 2.0f - 1.0f;
}

float FractalNoise(const glm::vec3& p) {
  return 0.57f * Noise(p) + 0.29f * Noise(p * 2.03f + 17.0f) + 0.14f * Noise(p * 4.11f + 31.0f);
}

}  // namespace furrow::character::generator
