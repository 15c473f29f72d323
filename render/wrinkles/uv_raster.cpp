// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/uv_raster.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

float Cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

// The remainder of a negative number is negative in C++.
int Wrapped(int value, int size) { return ((value % size) + size) % size; }

// A triangle in texel coordinates.
class TexelTriangle {
 public:
  TexelTriangle(const UvTriangle& triangle, glm::ivec2 size) {
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = triangle[i] * glm::vec2(size);
    area_ = Cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  }

  [[nodiscard]] glm::vec2 low() const {
    return glm::min(glm::min(corners_[0], corners_[1]), corners_[2]);
  }
  [[nodiscard]] glm::vec2 high() const {
    return glm::max(glm::max(corners_[0], corners_[1]), corners_[2]);
  }

  // Shares are ratios of signed areas, so triangles of both orientations work. A triangle without
  // area has only its edges.
  [[nodiscard]] UvTexel At(const glm::vec2& point) const {
    UvTexel texel;
    if (area_ != 0.0f) {
      for (int i = 0; i < 3; ++i) {
        const glm::vec2& next = Corner(i + 1);
        texel.shares[i] = Cross(Corner(i + 2) - next, point - next) / area_;
      }
      if (texel.shares.x >= 0.0f && texel.shares.y >= 0.0f && texel.shares.z >= 0.0f) return texel;
    }
    return Nearest(point);
  }

 private:
  [[nodiscard]] const glm::vec2& Corner(int i) const {
    return corners_[static_cast<std::size_t>(i % 3)];
  }

  // The nearest point on the edges.
  [[nodiscard]] UvTexel Nearest(const glm::vec2& point) const {
    UvTexel nearest;
    for (int i = 0; i < 3; ++i) {
      const glm::vec2 edge = Corner(i + 1) - Corner(i);
      const glm::vec2 from = point - Corner(i);
      const float length_squared = glm::dot(edge, edge);
      const float along = length_squared > 0.0f
                              ? std::clamp(glm::dot(from, edge) / length_squared, 0.0f, 1.0f)
                              : 0.0f;
      const glm::vec2 apart = from - along * edge;
      const float distance_squared = glm::dot(apart, apart);
      if (i > 0 && distance_squared >= nearest.distance_squared) continue;
      nearest.distance_squared = distance_squared;
      nearest.shares = glm::vec3(0.0f);
      nearest.shares[i] = 1.0f - along;
      nearest.shares[(i + 1) % 3] = along;
    }
    return nearest;
  }

  std::array<glm::vec2, 3> corners_;
  float area_ = 0.0f;  // twice the area
};

}  // namespace

void ForTexels(const UvTriangle& triangle, glm::ivec2 size, float reach,
               const std::function<void(const UvTexel&)>& visit) {
  const TexelTriangle texels(triangle, size);
  const glm::ivec2 first(glm::floor(texels.low() - reach));
  const glm::ivec2 last(glm::ceil(texels.high() + reach));
  for (int y = first.y; y < last.y; ++y) {
    for (int x = first.x; x < last.x; ++x) {
      UvTexel texel = texels.At(glm::vec2(x, y) + 0.5f);
      if (texel.distance_squared > reach * reach) continue;
      texel.index =
          static_cast<std::size_t>(Wrapped(y, size.y)) * static_cast<std::size_t>(size.x) +
          static_cast<std::size_t>(Wrapped(x, size.x));
      visit(texel);
    }
  }
}

bool IsAtlas(std::span<const UvTriangle> triangles) {
  // Limit of the summed area of the triangles' bounding boxes. A box is twice the area of its
  // triangle, more for slivers.
  constexpr float kMaxSurface = 16.0f;
  constexpr float kMaxTexel = 1024.0f;  // floats cannot resolve texels beyond this
  float surface = 0.0f;
  for (const UvTriangle& triangle : triangles) {
    for (const glm::vec2& corner : triangle) {
      if (!(std::abs(corner.x) < kMaxTexel && std::abs(corner.y) < kMaxTexel)) return false;
    }
    const glm::vec2 low = glm::min(glm::min(triangle[0], triangle[1]), triangle[2]);
    const glm::vec2 high = glm::max(glm::max(triangle[0], triangle[1]), triangle[2]);
    const glm::vec2 extent = high - low;
    if (extent.x > 1.0f || extent.y > 1.0f) return false;
    surface += extent.x * extent.y;
  }
  return surface <= kMaxSurface;
}

}  // namespace furrow::render
