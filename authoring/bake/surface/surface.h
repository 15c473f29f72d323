// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/surface/triangle_tree.h"
#include "character/character.h"
#include "wrinkle/drivers/strain/strain.h"

namespace furrow::authoring {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// A symmetric 2x2 tensor in the axes of a surface.
struct Tensor2 {
  float xx = 0.0f;
  float xy = 0.0f;
  float yy = 0.0f;
};
[[nodiscard]] inline Tensor2 operator+(const Tensor2& a, const Tensor2& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
[[nodiscard]] inline Tensor2 operator*(float s, const Tensor2& t) {
  return {s * t.xx, s * t.xy, s * t.yy};
}

// A rotation within a surface, as the cosine and sine of its angle.
struct PlaneRotation {
  float cosine = 1.0f;
  float sine = 0.0f;
};
// The rotation that carries directions from one tangent plane to another without twist: the turn
// that remains in the plane after the normal of `from` has been rotated to that of `to`.
[[nodiscard]] PlaneRotation Transport(const wrinkle::SurfaceAxes& from,
                                      const wrinkle::SurfaceAxes& to);
// Converts a tensor from the axes `from` to the axes `to` of Transport().
[[nodiscard]] Tensor2 Carry(const Tensor2& tensor, const PlaneRotation& turn);

// Orthonormal axes perpendicular to a unit normal. Their rotation about the normal is arbitrary.
[[nodiscard]] wrinkle::SurfaceAxes AxesAcross(const glm::vec3& normal);

// A point on a surface, as barycentric coordinates in a triangle.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  glm::vec3 corners{1.0f, 0.0f, 0.0f};  // barycentric coordinates
  glm::vec3 position{0.0f};             // metres
};

// Several meshes in the rest pose as one surface that is continuous across UV seams.
//
// - Vertices of one mesh are welded if they share a position and all skin weights. The two sides of
//   a UV seam become one. Closed lips stay apart, since different joints move them.
// - Meshes are never connected to each other.
class Surface {
 public:
  struct Triangle {
    std::array<std::uint32_t, 3> vertices{};  // welded
    // The triangles across the edges (0, 1), (1, 2), (2, 0); kNoTriangle at a border.
    std::array<std::uint32_t, 3> neighbours{kNoTriangle, kNoTriangle, kNoTriangle};
    wrinkle::SurfaceAxes axes;
    float area = 0.0f;                            // square metres
    std::optional<wrinkle::RestTriangle> strain;  // empty: a degenerate triangle without strain
  };

  // Precondition: the meshes' indices are in range, and their skin weights name joints of the
  // skeleton.
  explicit Surface(std::span<const character::Mesh* const> meshes);

  // All meshes concatenated, with their morph targets. The corners of triangle t are at indices 3
  // t, 3 t + 1 and 3 t + 2.
  [[nodiscard]] const character::Mesh& mesh() const { return mesh_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  [[nodiscard]] std::span<const glm::vec3> positions() const { return positions_; }   // welded
  [[nodiscard]] std::span<const wrinkle::SurfaceAxes> axes() const { return axes_; }  // welded
  // The positions of the welded vertices with morph targets applied; see MorphedPositions().
  [[nodiscard]] std::vector<glm::vec3> Morphed(std::span<const float> shape_weights) const;
  // One of the vertices of mesh() that a welded vertex replaces.
  [[nodiscard]] const character::Vertex& SourceOf(std::size_t welded) const {
    return mesh_.vertices[source_[welded]];
  }
  // The triangles around a welded vertex.
  [[nodiscard]] std::span<const std::uint32_t> Around(std::size_t welded) const {
    return std::span(fans_).subspan(fan_starts_[welded],
                                    fan_starts_[welded + 1] - fan_starts_[welded]);
  }
  // Interpolates a value per welded vertex.
  [[nodiscard]] float Interpolate(std::span<const float> values, const SurfacePoint& point) const {
    const auto& v = triangles_[point.triangle].vertices;
    return values[v[0]] * point.corners.x + values[v[1]] * point.corners.y +
           values[v[2]] * point.corners.z;
  }
  // Interpolates a tensor per welded vertex. The tensors are in their vertices' axes; the result is
  // in the axes of the point's triangle.
  [[nodiscard]] Tensor2 Interpolate(std::span<const Tensor2> tensors,
                                    const SurfacePoint& point) const;
  // The positions of a triangle's corners, metres.
  [[nodiscard]] std::array<glm::vec3, 3> Corners(std::uint32_t triangle) const;

  // The nearest point of the surface. Degenerate triangles are ignored unless there are no others.
  // Precondition: the surface has a triangle.
  [[nodiscard]] SurfacePoint Nearest(const glm::vec3& p) const;
  // The point with the given barycentric coordinates of a triangle.
  [[nodiscard]] SurfacePoint PointOf(std::uint32_t triangle, const glm::vec3& corners) const;

 private:
  void Append(const character::Mesh& mesh);
  void AppendTargets(const character::Mesh& mesh, std::uint32_t base);
  void Connect();
  void MakeAxes();
  void MakeTree();

  character::Mesh mesh_;
  std::vector<Triangle> triangles_;
  std::vector<glm::vec3> positions_;
  std::vector<wrinkle::SurfaceAxes> axes_;
  std::vector<std::uint32_t> source_;
  std::vector<std::uint32_t> fans_;
  std::vector<std::size_t> fan_starts_;
  std::optional<TriangleTree> tree_;
};

// Finds triangles within a distance of a point, measured over the surface, so that effects do not
// leak from one lip or finger to the next. Reuses its memory between searches. Not thread-safe.
class SurfaceSearch {
 public:
  // `surface` must outlive the search.
  explicit SurfaceSearch(const Surface& surface);

  // The triangles within `radius` metres of `centre` that are connected to `seeds` by a path not
  // much longer than the straight line. The result is valid until the next search.
  [[nodiscard]] std::span<const std::uint32_t> Find(const glm::vec3& centre,
                                                    std::span<const std::uint32_t> seeds,
                                                    float radius);

 private:
  struct Entry {
    float length;
    std::uint32_t triangle;
    glm::vec3 point;
  };

  const Surface& surface_;
  std::vector<std::uint32_t> stamps_;
  std::uint32_t stamp_ = 0;
  std::vector<Entry> heap_;
  std::vector<std::uint32_t> found_;
};

}  // namespace furrow::authoring
