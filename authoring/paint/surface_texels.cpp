// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/surface_texels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

int Wrap(int value, int size) {
  const int rest = value % size;
  return rest < 0 ? rest + size : rest;
}

float Cross(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

// Normal and tangent are made orthonormal again, because interpolation shortens and tilts them. The
// handedness is the same for the whole triangle.
SurfaceTexel Interpolate(const character::Vertex& a, const character::Vertex& b,
                         const character::Vertex& c, glm::vec3 w) {
  SurfaceTexel texel;
  texel.position = w.x * a.position + w.y * b.position + w.z * c.position;
  const glm::vec3 normal = w.x * a.normal + w.y * b.normal + w.z * c.normal;
  const float length = glm::length(normal);
  texel.normal = length > 1e-6f ? normal / length : a.normal;
  glm::vec3 tangent =
      w.x * glm::vec3(a.tangent) + w.y * glm::vec3(b.tangent) + w.z * glm::vec3(c.tangent);
  tangent -= texel.normal * glm::dot(texel.normal, tangent);
  const float tangent_length = glm::length(tangent);
  texel.tangent = tangent_length > 1e-6f ? tangent / tangent_length : glm::vec3(a.tangent);
  texel.bitangent = glm::cross(texel.normal, texel.tangent) * a.tangent.w;
  texel.corners = w;
  return texel;
}

// Fills the texels of one triangle. Edges belong to the triangle, so neighbours leave no gap. The
// first triangle keeps a shared texel.
class TriangleFill {
 public:
  TriangleFill(int width, int height, std::vector<char>* covered, std::vector<SurfaceTexel>* out)
      : width_(width), height_(height), covered_(*covered), out_(*out) {}

  [[nodiscard]] std::int64_t overlaps() const { return overlaps_; }

  void Fill(std::uint32_t triangle, const character::Vertex& a, const character::Vertex& b,
            const character::Vertex& c) {
    const glm::vec2 size(static_cast<float>(width_), static_cast<float>(height_));
    const glm::vec2 pa = a.uv * size, pb = b.uv * size, pc = c.uv * size;
    const float area = Cross(pb - pa, pc - pa);
    if (!(std::abs(area) > 1e-9f)) return;
    const glm::vec2 low = glm::min(pa, glm::min(pb, pc));
    const glm::vec2 high = glm::max(pa, glm::max(pb, pc));
    constexpr float kFarthest = 1e6f;  // texels; an int could not count more
    if (!(std::max({-low.x, -low.y, high.x, high.y}) < kFarthest)) return;
    const int first_y = static_cast<int>(std::ceil(low.y - 0.5f));
    // A triangle covers each texel at most once: beyond one repeat of the texture it would only
    // overlap itself.
    const int last_y = std::min(static_cast<int>(std::floor(high.y - 0.5f)), first_y + height_ - 1);
    const int first_x = static_cast<int>(std::ceil(low.x - 0.5f));
    const int last_x = std::min(static_cast<int>(std::floor(high.x - 0.5f)), first_x + width_ - 1);
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const glm::vec3 w(Cross(pb - p, pc - p) / area, Cross(pc - p, pa - p) / area,
                          Cross(pa - p, pb - p) / area);
        const float inside = std::min({w.x, w.y, w.z});
        if (inside < -1e-5f) continue;
        if (!Claim(x, y)) {
          overlaps_ += inside > kWellInside ? 1 : 0;
          continue;
        }
        SurfaceTexel texel = Interpolate(a, b, c, w);
        texel.x = Wrap(x, width_);
        texel.y = Wrap(y, height_);
        texel.triangle = triangle;
        out_.push_back(texel);
      }
    }
  }

 private:
  // Neighbours both cover a texel on their common edge. That is not an overlap.
  static constexpr float kWellInside = 0.02f;

  // True for the first triangle on the texel.
  bool Claim(int x, int y) {
    char& covered =
        covered_[static_cast<std::size_t>(Wrap(y, height_)) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(Wrap(x, width_))];
    if (covered) return false;
    covered = 1;
    return true;
  }

  int width_;
  int height_;
  std::vector<char>& covered_;
  std::vector<SurfaceTexel>& out_;
  std::int64_t overlaps_ = 0;
};

}  // namespace

std::vector<SurfaceTexel> RasterizeSurface(const character::Mesh& mesh, int width, int height,
                                           std::int64_t* overlaps) {
  std::vector<SurfaceTexel> texels;
  std::vector<char> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  TriangleFill fill(width, height, &covered, &texels);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    fill.Fill(static_cast<std::uint32_t>(i / 3), mesh.vertices[mesh.indices[i]],
              mesh.vertices[mesh.indices[i + 1]], mesh.vertices[mesh.indices[i + 2]]);
  }
  if (overlaps != nullptr) *overlaps = fill.overlaps();
  // Row order is independent of the order of triangles and suits pictures.
  std::sort(texels.begin(), texels.end(), [](const SurfaceTexel& a, const SurfaceTexel& b) {
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return texels;
}

}  // namespace furrow::authoring
