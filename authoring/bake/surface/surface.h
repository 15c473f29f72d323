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

namespace furrow::character::bake {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// A symmetric 2x2 tensor in axes of the surface.
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

// The cosine and sine of the angle by which axes are turned against others after they were carried
// over the surface (by the shortest rotation of one normal onto the other).
struct Turn {
  float cosine = 1.0f;
  float sine = 0.0f;
};
[[nodiscard]] Turn Transport(const wrinkle::SurfaceAxes& from, const wrinkle::SurfaceAxes& to);
// A tensor of the axes that a turn starts from, in the axes that it leads to.
[[nodiscard]] Tensor2 Carry(const Tensor2& tensor, const Turn& turn);

// Axes across a unit normal, wherever they point.
[[nodiscard]] wrinkle::SurfaceAxes AxesAcross(const glm::vec3& normal);

// A place on a surface: everything that varies over it is read there from the triangle's corners.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  glm::vec3 corners{1.0f, 0.0f, 0.0f};  // barycentric
  glm::vec3 position{0.0f};             // metres
};

// Some meshes as one surface at rest, whole across UV seams.
//
// - Vertices of one mesh are welded where they lie on the same place and every joint moves them
//   alike: so the two sides of a UV seam are one, and closed lips, which lie upon each other and
//   move apart, are not.
// - Nothing connects one mesh to another.
class Surface {
 public:
  struct Triangle {
    std::array<std::uint32_t, 3> vertices{};  // welded
    // Across the edges (0, 1), (1, 2), (2, 0); kNoTriangle at a border.
    std::array<std::uint32_t, 3> neighbours{kNoTriangle, kNoTriangle, kNoTriangle};
    wrinkle::SurfaceAxes axes;
    float area = 0.0f;                            // square metres
    std::optional<wrinkle::RestTriangle> strain;  // none: degenerate, says nothing of strain
  };

  // The meshes' skin weights must be in order: indices in range, joints in the skeleton.
  explicit Surface(std::span<const Mesh* const> meshes);

  // All meshes in one list: triangle t of the surface has its corners at indices 3 t, 3 t + 1, ...
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  [[nodiscard]] std::span<const glm::vec3> positions() const { return positions_; }   // welded
  [[nodiscard]] std::span<const wrinkle::SurfaceAxes> axes() const { return axes_; }  // welded
  // A vertex of mesh() that a welded vertex stands for.
  [[nodiscard]] const Vertex& SourceOf(std::size_t welded) const {
    return mesh_.vertices[source_[welded]];
  }
  // Triangles around a welded vertex.
  [[nodiscard]] std::span<const std::uint32_t> Around(std::size_t welded) const {
    return std::span(fans_).subspan(fan_starts_[welded],
                                    fan_starts_[welded + 1] - fan_starts_[welded]);
  }
  // A value that is known at the welded vertices.
  [[nodiscard]] float Interpolate(std::span<const float> values, const SurfacePoint& point) const {
    const auto& v = triangles_[point.triangle].vertices;
    return values[v[0]] * point.corners.x + values[v[1]] * point.corners.y +
           values[v[2]] * point.corners.z;
  }
  // A tensor in the vertices' axes, as one in the triangle's.
  [[nodiscard]] Tensor2 Interpolate(std::span<const Tensor2> tensors,
                                    const SurfacePoint& point) const;
  [[nodiscard]] std::array<glm::vec3, 3> Corners(std::uint32_t triangle) const;

  // The nearest point of the surface, which must have a triangle; of those without extent none,
  // where there are others.
  [[nodiscard]] SurfacePoint Nearest(const glm::vec3& p) const;
  // A point of a triangle by its barycentric coordinates.
  [[nodiscard]] SurfacePoint PointOf(std::uint32_t triangle, const glm::vec3& corners) const;

 private:
  void Append(const Mesh& mesh);
  void Connect();
  void MakeAxes();
  void MakeTree();

  Mesh mesh_;
  std::vector<Triangle> triangles_;
  std::vector<glm::vec3> positions_;
  std::vector<wrinkle::SurfaceAxes> axes_;
  std::vector<std::uint32_t> source_;
  std::vector<std::uint32_t> fans_;
  std::vector<std::size_t> fan_starts_;
  std::optional<TriangleTree> tree_;
};

// Finds what lies within a distance of a point *over the surface*, so that nothing leaks from one
// lip or finger to the next. Keeps its memory between searches; one thread at a time.
class SurfaceReach {
 public:
  explicit SurfaceReach(const Surface& surface);

  // The triangles that come within `radius` metres of `centre` and can be walked to from `seeds`
  // on a way that is not much longer than the straight one. Valid until the next search.
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

}  // namespace furrow::character::bake
