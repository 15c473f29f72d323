// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/uv_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "wrinkle/drivers/strain/strain.h"

namespace furrow::authoring {
namespace {

constexpr std::int64_t kSubsamples = 256;  // fixed-point units per sample
constexpr std::int64_t kMaxRounds = 64;    // maximum number of visits, per sample of the atlas
constexpr float kFarthestUv = 1024.0f;     // larger values are not texture coordinates

struct Corner {
  std::int64_t x = 0;
  std::int64_t y = 0;
};
using Corners = std::array<Corner, 3>;

// Twice the signed area; positive if a, b, c turn from +x to +y.
std::int64_t Cross(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether samples exactly on the edge from a to b belong to the triangle on its positive side.
bool OwnsEdge(const Corner& a, const Corner& b) { return (a.y == b.y && b.x > a.x) || b.y < a.y; }

bool Covers(const Corners& t, const Corner& sample) {
  for (int i = 0; i < 3; ++i) {
    const Corner& a = t[i];
    const Corner& b = t[(i + 1) % 3];
    const std::int64_t side = Cross(a, b, sample);
    if (side < 0 || (side == 0 && !OwnsEdge(a, b))) return false;
  }
  return true;
}

// C++ rounds towards zero, which is wrong for negative coordinates.
std::int64_t FloorDivide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

// Records the first triangle on each sample of the atlas, and counts samples with several.
class Atlas {
 public:
  explicit Atlas(int size) : size_(size), owner_(static_cast<std::size_t>(size) * size) {}

  struct Owner {
    int mesh = -1;
    int triangle = -1;
    bool shared = false;
  };

  // Returns false once the limit of visits is reached.
  bool Paint(const std::array<glm::vec2, 3>& uvs, const Owner& who, UvReport* report) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 scaled = glm::dvec2(uvs[i]) * static_cast<double>(size_ * kSubsamples);
      corners[i] = {std::llround(scaled.x), std::llround(scaled.y)};
    }
    if (Cross(corners[0], corners[1], corners[2]) < 0) std::swap(corners[1], corners[2]);
    const auto [left, right] = Range(corners, &Corner::x);
    const auto [top, bottom] = Range(corners, &Corner::y);
    for (std::int64_t y = top; y <= bottom; ++y) {
      for (std::int64_t x = left; x <= right; ++x) {
        if (++visits_ > kMaxRounds * size_ * size_) return false;
        const Corner centre{x * kSubsamples + kSubsamples / 2, y * kSubsamples + kSubsamples / 2};
        if (Covers(corners, centre)) Claim(x, y, who, report);
      }
    }
    return true;
  }

  void Finish(UvReport* report) const {
    const double all = static_cast<double>(size_) * size_;
    report->covered = static_cast<float>(static_cast<double>(covered_) / all);
    if (covered_ == 0) return;
    report->overlapping =
        static_cast<float>(static_cast<double>(shared_) / static_cast<double>(covered_));
  }

 private:
  // The range of samples with centres between the corners.
  static std::pair<std::int64_t, std::int64_t> Range(const Corners& t, std::int64_t Corner::*axis) {
    const auto [low, high] = std::minmax({t[0].*axis, t[1].*axis, t[2].*axis});
    return {FloorDivide(low - kSubsamples / 2, kSubsamples),
            FloorDivide(high - kSubsamples / 2, kSubsamples) + 1};
  }

  void Claim(std::int64_t x, std::int64_t y, const Owner& who, UvReport* report) {
    const auto wrap = [this](std::int64_t i) { return ((i % size_) + size_) % size_; };
    Owner& owner = owner_[static_cast<std::size_t>(wrap(y) * size_ + wrap(x))];
    if (owner.mesh < 0) {
      owner = who;
      ++covered_;
      return;
    }
    shared_ += owner.shared ? 0 : 1;
    owner.shared = true;
    if (report->example) return;
    const auto uv = [this](std::int64_t i) {
      return (static_cast<float>(i) + 0.5f) / static_cast<float>(size_);
    };
    report->example = UvReport::Overlap{.meshes = {owner.mesh, who.mesh},
                                        .triangles = {owner.triangle, who.triangle},
                                        .uv = {uv(wrap(x)), uv(wrap(y))}};
  }

  std::int64_t size_;
  std::vector<Owner> owner_;
  std::int64_t covered_ = 0;
  std::int64_t shared_ = 0;
  std::int64_t visits_ = 0;
};

// Counts the connected pieces of a mesh. Vertices with the same position and UV are the same.
int CountIslands(const character::Mesh& mesh) {
  using Key = std::tuple<float, float, float, float, float>;
  std::map<Key, std::uint32_t> first;
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    const character::Vertex& v = mesh.vertices[i];
    const Key key{v.position.x, v.position.y, v.position.z, v.uv.x, v.uv.y};
    parent[i] = first.emplace(key, i).first->second;
  }
  const auto root = [&](std::uint32_t i) {
    // Union-find with path halving.
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<bool> used(parent.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t corner = root(mesh.indices[i]);
    used[corner] = true;
    parent[root(mesh.indices[i + 1])] = corner;
    parent[root(mesh.indices[i + 2])] = corner;
  }
  int islands = 0;
  for (std::uint32_t i = 0; i < parent.size(); ++i) islands += used[i] && root(i) == i;
  return islands;
}

bool IsUsable(const glm::vec2& uv) {
  return std::abs(uv.x) < kFarthestUv && std::abs(uv.y) < kFarthestUv;  // false for NaN
}

bool IsOutside(const glm::vec2& uv) {
  constexpr float kSlack = 1e-4f;
  return std::min(uv.x, uv.y) < -kSlack || std::max(uv.x, uv.y) > 1.0f + kSlack;
}

float Area(const std::array<glm::vec2, 3>& t) {
  const glm::vec2 u = t[1] - t[0];
  const glm::vec2 v = t[2] - t[0];
  return 0.5f * std::abs(u.x * v.y - u.y * v.x);
}

}  // namespace

UvReport CheckUvs(const character::Character& character, std::span<const int> meshes, int size) {
  constexpr float kLeastUvArea = 1e-12f;
  UvReport report;
  Atlas atlas(size);
  bool painting = true;
  for (const int index : meshes) {
    const character::Mesh& mesh = character.meshes[static_cast<std::size_t>(index)];
    report.islands += CountIslands(mesh);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      ++report.triangles;
      const character::Vertex* corners[3];
      std::array<glm::vec2, 3> uvs;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = &mesh.vertices[mesh.indices[i + k]];
        uvs[k] = corners[k]->uv;
      }
      if (!wrinkle::MakeRestTriangle(corners[0]->position, corners[1]->position,
                                     corners[2]->position, {})) {
        ++report.degenerate_triangles;
      } else if (!std::all_of(uvs.begin(), uvs.end(), IsUsable) || !(Area(uvs) > kLeastUvArea)) {
        ++report.unmapped_triangles;
      } else {
        report.outside_triangles += std::any_of(uvs.begin(), uvs.end(), IsOutside);
        painting = painting && atlas.Paint(uvs, {index, static_cast<int>(i / 3)}, &report);
      }
    }
  }
  atlas.Finish(&report);
  return report;
}

}  // namespace furrow::authoring
