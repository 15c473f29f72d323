// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/hair_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/hair_style.h"
#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/hair_strands.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"
#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kSections = 7;              // of a lock, root to tip
constexpr int kMaxLocks = 1800;           // limits the number of triangles
constexpr float kCapTop = kStrandBottom;  // v: strands above, the cap below
constexpr float kCapBehind =
    0.6f;  // centimetres; in front of it the hairline consists of strands only
constexpr float kLockArea = 0.52f;  // square centimetres of scalp per lock

std::uint32_t AddHairVertex(HeadMesh* hair, const vec3& place, const vec2& uv) {
  HeadVertex info;
  info.part = kHairCap;
  info.place = place;
  return AddHeadVertex(hair, info, uv);
}

// Adds a thin dark cap, so that no skin shows between the locks.
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
    place += grid.shape().Normal(place) *
             (-0.12f + 0.20f * Smoothstep(-0.3f, 1.2f, inside - kCapBehind));
    if (std::abs(c) == last) place.x = 0.0f;
    const vec3 normal = grid.shape().Normal(place);
    const vec2 uv = glm::mix(vec2(0.01f), vec2(0.99f), HeadUv(grid.Plain(c, r)));
    index = AddHairVertex(hair, place, {uv.x, kCapTop + 0.01f + (0.98f - kCapTop) * uv.y});
    hair->mesh.vertices[index].normal = normal;
    return index;
  };
  for (int c = -last; c < last; ++c) {
    for (int r = 0; r + 1 < rows; ++r) {
      const float best =
          std::max({InsideHairline(skin[at(c, r)]), InsideHairline(skin[at(c + 1, r)]),
                    InsideHairline(skin[at(c + 1, r + 1)]), InsideHairline(skin[at(c, r + 1)])});
      if (best < kCapBehind) continue;
      AddQuad(&hair->mesh, vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1), vertex(c, r + 1));
    }
  }
}

// Adds one lock: a card along the path. Its normals fan out a little, as if it were round.
// Otherwise they follow the scalp: locks that were lit one by one would look like scales.
void AddLock(const HairLock& lock, int tile, HeadMesh* hair) {
  constexpr float kFan = 0.3f;
  const auto first = static_cast<std::uint32_t>(hair->mesh.vertices.size());
  const int count = static_cast<int>(lock.path.size());
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const vec3 along =
        glm::normalize(lock.path[std::min(i + 1, count - 1)] - lock.path[std::max(i - 1, 0)]);
    const vec3 across = glm::normalize(glm::cross(lock.out[i], along));
    const float width = lock.width * (0.8f + 0.2f * Smoothstep(0.0f, 0.2f, t)) * (1.0f - 0.35f * t);
    for (const float s : {-1.0f, 1.0f}) {
      const std::uint32_t added =
          AddHairVertex(hair, lock.path[i] + across * (s * width), StrandUv(tile, s, t));
      hair->mesh.vertices[added].normal = glm::normalize(lock.out[i] + kFan * s * across);
    }
  }
  for (int i = 0; i + 1 < count; ++i) {
    const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
    AddQuad(&hair->mesh, a, a + 2, a + 3, a + 1);
  }
}

// Dense tiles inside, sparse ones at the hairline.
int ChooseTile(float inside, int number) {
  const bool sparse = RandomAt(number, 10, 9) < Smoothstep(1.1f, 0.2f, inside);
  const float choice = RandomAt(number, 11, 9);
  return sparse ? kFullTiles + static_cast<int>(choice * kSparseTiles)
                : static_cast<int>(choice * kFullTiles);
}

// The area of a cell of the grid, square centimetres.
float CellArea(const HeadGrid& grid, int c, int r) {
  const vec3 a = grid.Surface(grid.Plain(c, r)), b = grid.Surface(grid.Plain(c + 1, r));
  const vec3 d = grid.Surface(grid.Plain(c, r + 1)), e = grid.Surface(grid.Plain(c + 1, r + 1));
  return 0.5f * (glm::length(glm::cross(b - a, d - a)) + glm::length(glm::cross(e - b, e - d)));
}

}  // namespace

HeadMesh MakeHair(const HeadShape& shape) {
  const HeadGrid grid(shape);
  HeadMesh hair;
  hair.mesh.name = "hair";
  AddCap(grid, &hair);
  int number = 0;
  float due = 0.0f;  // number of locks that the area so far allows
  for (int c = -grid.num_columns(); c < grid.num_columns(); ++c) {
    for (int r = 0; r + 1 < grid.num_rows(); ++r) {
      const vec3 middle = grid.Surface(0.5f * (grid.Plain(c, r) + grid.Plain(c + 1, r + 1)));
      const float inside = InsideHairline(middle);
      if (inside < -0.25f) continue;
      // Denser at the hairline, where gaps would show.
      due += CellArea(grid, c, r) / (kLockArea * (inside < 0.9f ? 0.4f : 1.0f));
      for (; due >= 1.0f && number < kMaxLocks; due -= 1.0f, ++number) {
        const vec2 jitter(RandomAt(number, 1, 7), RandomAt(number, 2, 7));
        const vec3 root =
            grid.Surface(glm::mix(grid.Plain(c, r), grid.Plain(c + 1, r + 1), jitter));
        const float depth = InsideHairline(root);
        if (depth < -0.2f) continue;
        const HairLock lock = GrowLock(shape, root, number, kSections);
        if (!lock.path.empty()) AddLock(lock, ChooseTile(depth, number), &hair);
      }
    }
  }
  int wound = 0;
  for (const HairLock& lock : WindKnot(shape, kSections)) {
    AddLock(lock, wound++ % kFullTiles, &hair);
  }
  character::paint::ComputeTangents(hair.mesh.vertices, hair.mesh.indices);
  return hair;
}

}  // namespace furrow::authoring
