// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_walk.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr std::uint32_t kNone = 0xffffffffu;

// The triangles across the edges of each triangle.
std::vector<std::array<std::uint32_t, 3>> NeighboursOf(const FineMesh& mesh) {
  struct Side {
    std::uint64_t key;
    std::uint32_t triangle, edge;
  };
  std::vector<Side> sides;
  const auto triangles = mesh.triangles();
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t].vertices[k], b = triangles[t].vertices[(k + 1) % 3];
      if (a == b) continue;
      sides.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  std::vector<std::array<std::uint32_t, 3>> neighbours(triangles.size(), {kNone, kNone, kNone});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.key != b.key) continue;
    neighbours[a.triangle][a.edge] = b.triangle;
    neighbours[b.triangle][b.edge] = a.triangle;
    ++i;
  }
  return neighbours;
}

}  // namespace

CreaseWalk::CreaseWalk(const FineMesh& mesh, const CreaseField& field, std::uint32_t seed)
    : mesh_(mesh),
      field_(field),
      seed_(seed),
      neighbours_(NeighboursOf(mesh)),
      first_triangle_(mesh.vertices().size(), kNone) {
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    if (!(glm::length(AreaOf(t)) > 1e-12f)) continue;
    for (const std::uint32_t corner : mesh.triangles()[t].vertices) {
      if (first_triangle_[corner] == kNone) first_triangle_[corner] = t;
    }
  }
}

std::optional<CreaseWalk::Spot> CreaseWalk::StartAt(std::uint32_t vertex) const {
  if (first_triangle_[vertex] == kNone) return std::nullopt;
  Spot spot{.triangle = first_triangle_[vertex],
            .corners = vec3(0.0f),
            .direction = field_.along[vertex]};
  const auto& corners = mesh_.triangles()[spot.triangle].vertices;
  for (int k = 0; k < 3; ++k) {
    if (corners[static_cast<std::size_t>(k)] == vertex) spot.corners[k] = 1.0f;
  }
  // Inside the triangle, from where all directions lead out.
  spot.corners = 0.9f * spot.corners + vec3(0.1f / 3.0f);
  return spot;
}

vec3 CreaseWalk::AreaOf(std::uint32_t triangle) const {
  const auto& v = mesh_.triangles()[triangle].vertices;
  const auto p = mesh_.positions();
  return glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
}

// The direction of creases at a spot, in the plane of its triangle.
vec3 CreaseWalk::DirectionAt(const Spot& spot, const vec3& normal) const {
  const auto& v = mesh_.triangles()[spot.triangle].vertices;
  vec3 sum(0.0f);
  for (int k = 0; k < 3; ++k) {
    const vec3& along = field_.along[v[static_cast<std::size_t>(k)]];
    sum += spot.corners[k] * (glm::dot(along, spot.direction) < 0.0f ? -along : along);
  }
  const vec3 place = PlaceOf(spot);
  const float noise =
      SignedNoise(place / (2.5f * At(std::span<const float>(field_.spacing), spot)) +
                  vec3(1.0f, 5.3f * static_cast<float>(seed_ % 89), 7.0f));
  const float angle = 1.5f * At(std::span<const float>(field_.tilt), spot) * noise;
  sum = std::cos(angle) * sum + std::sin(angle) * glm::cross(normal, sum);
  sum -= normal * glm::dot(sum, normal);
  // A crease bends no more sharply than cloth does.
  const vec3 before = UnitOr(spot.direction - normal * glm::dot(spot.direction, normal), sum);
  return UnitOr(0.7f * before + 0.3f * UnitOr(sum, before), before);
}

bool CreaseWalk::Step(Spot* spot, float* walked) const {
  const auto& v = mesh_.triangles()[spot->triangle].vertices;
  const auto p = mesh_.positions();
  const vec3 area = AreaOf(spot->triangle);
  const float square = glm::dot(area, area);
  if (!(square > 1e-20f)) return false;
  const vec3 normal = area / std::sqrt(square);
  spot->direction = DirectionAt(*spot, normal);
  float least = 1e9f;
  int exit = -1;
  for (int i = 0; i < 3; ++i) {
    const vec3& a = p[v[static_cast<std::size_t>((i + 1) % 3)]];
    const vec3& b = p[v[static_cast<std::size_t>((i + 2) % 3)]];
    const float change = glm::dot(glm::cross(area, b - a), spot->direction) / square;
    if (!(change < -1e-9f)) continue;
    const float until = std::max(spot->corners[i], 0.0f) / -change;
    if (until < least) least = until, exit = i;
  }
  if (exit < 0) return false;
  vec3 corners = spot->corners;
  for (int i = 0; i < 3; ++i) {
    const vec3& a = p[v[static_cast<std::size_t>((i + 1) % 3)]];
    const vec3& b = p[v[static_cast<std::size_t>((i + 2) % 3)]];
    corners[i] += least * glm::dot(glm::cross(area, b - a), spot->direction) / square;
  }
  corners[exit] = 0.0f;
  corners = glm::max(corners, vec3(0.0f));
  corners /= std::max(corners.x + corners.y + corners.z, 1e-9f);
  *walked = least;
  // The edge across corner i begins at corner i + 1.
  const std::uint32_t next = neighbours_[spot->triangle][static_cast<std::size_t>((exit + 1) % 3)];
  if (next == kNone) return false;
  const auto& w = mesh_.triangles()[next].vertices;
  vec3 there(0.0f);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (w[static_cast<std::size_t>(k)] == v[static_cast<std::size_t>(i)]) there[k] = corners[i];
    }
  }
  const vec3 turned = UnitOr(AreaOf(next), normal);
  spot->triangle = next;
  spot->corners = there;
  spot->direction =
      UnitOr(spot->direction - turned * glm::dot(turned, spot->direction), spot->direction);
  return true;
}

}  // namespace furrow::authoring
