// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/cell_grid.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kMostWalks = 4000;
// A crease ends this near to another, in spacings.
constexpr float kMeets = 0.4f;
// The cosine of the angle at which creases join.
constexpr float kJoins = 0.75f;
// The length over which loose ends fade, in spacings.
constexpr float kFade = 2.5f;
constexpr float kJoint = 0.4f;  // likewise, where it joins another
// The least length of shallow creases, and of creases without neighbours, in spacings.
constexpr float kShallow = 2.0f;
constexpr float kAlone = 4.5f;
constexpr float kStep = 0.005f;  // between points, metres

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

// Finds points of creases within a distance.
class PointGrid {
 public:
  explicit PointGrid(float cell) : grid_(cell) {}
  struct Entry {
    vec3 place, normal, along;
    std::uint32_t crease;
    float length;  // from the start of the crease
  };
  void Add(const Entry& entry) { grid_.Add(entry.place, entry); }
  template <class Visit>
  void Near(const vec3& place, float radius, const Visit& visit) const {
    grid_.Within(place - vec3(radius), place + vec3(radius), [&](const Entry& entry) {
      if (glm::distance(entry.place, place) <= radius) visit(entry);
    });
  }

 private:
  CellGrid<Entry> grid_;
};

class Layer {
 public:
  Layer(const FineMesh& mesh, const CreaseField& field, std::span<const float> excess,
        const CreaseOptions& options)
      : mesh_(mesh),
        field_(field),
        excess_(excess),
        options_(options),
        neighbours_(NeighboursOf(mesh)),
        normals_(NormalsOf(mesh)),
        first_triangle_(mesh.vertices().size(), kNone),
        grid_(0.05f) {
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
      const auto& v = mesh.triangles()[t].vertices;
      const vec3 area = AreaOf(t);
      for (const std::uint32_t corner : v) {
        if (first_triangle_[corner] == kNone && glm::length(area) > 1e-12f)
          first_triangle_[corner] = t;
      }
    }
  }

  std::vector<Crease> Lay() {
    std::vector<std::uint32_t> order;
    std::vector<float> rank(mesh_.vertices().size(), 0.0f);
    for (std::uint32_t v = 0; v < rank.size(); ++v) {
      if (field_.excess[v] < options_.start || first_triangle_[v] == kNone) continue;
      const float noise = RandomAt(static_cast<int>(v), static_cast<int>(options_.seed), 71);
      rank[v] = field_.excess[v] * (0.85f + 0.3f * noise);
      order.push_back(v);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return rank[a] != rank[b] ? rank[a] > rank[b] : a < b;
    });
    for (const std::uint32_t v : order) {
      if (!IsFree(mesh_.positions()[v], normals_[v], SpacingAt(v))) continue;
      Trace(v);
    }
    MeasureSides();
    Discard();
    Fade();
    return std::move(creases_);
  }

 private:
  struct Spot {
    std::uint32_t triangle = 0;
    vec3 corners{1.0f, 0.0f, 0.0f};
    vec3 direction{0.0f};
  };

  [[nodiscard]] vec3 AreaOf(std::uint32_t t) const {
    const auto& v = mesh_.triangles()[t].vertices;
    const auto p = mesh_.positions();
    return glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
  }
  template <class T>
  [[nodiscard]] T At(std::span<const T> values, const Spot& spot) const {
    const auto& v = mesh_.triangles()[spot.triangle].vertices;
    return values[v[0]] * spot.corners.x + values[v[1]] * spot.corners.y +
           values[v[2]] * spot.corners.z;
  }
  [[nodiscard]] vec3 PlaceOf(const Spot& spot) const {
    const auto& v = mesh_.triangles()[spot.triangle].vertices;
    const auto p = mesh_.positions();
    return p[v[0]] * spot.corners.x + p[v[1]] * spot.corners.y + p[v[2]] * spot.corners.z;
  }
  [[nodiscard]] float SpacingAt(std::uint32_t v) const {
    const float noise =
        SignedNoise(mesh_.positions()[v] / (2.0f * field_.spacing[v]) +
                    vec3(3.7f * static_cast<float>(options_.seed % 97), 9.0f, 2.0f));
    return options_.nearest * field_.spacing[v] * (1.0f + 1.6f * options_.variation * noise);
  }

  // No crease is nearer than `distance`.
  [[nodiscard]] bool IsFree(const vec3& place, const vec3& normal, float distance) const {
    bool free = true;
    grid_.Near(place, distance, [&](const PointGrid::Entry& entry) {
      free = free && glm::dot(entry.normal, normal) < kSameSide;
    });
    return free;
  }

  // The direction of creases at a spot, in the plane of its triangle.
  [[nodiscard]] vec3 DirectionAt(const Spot& spot, const vec3& normal) const {
    const auto& v = mesh_.triangles()[spot.triangle].vertices;
    vec3 sum(0.0f);
    for (int k = 0; k < 3; ++k) {
      const vec3& along = field_.along[v[static_cast<std::size_t>(k)]];
      sum += spot.corners[k] * (glm::dot(along, spot.direction) < 0.0f ? -along : along);
    }
    const vec3 place = PlaceOf(spot);
    const float noise =
        SignedNoise(place / (2.5f * At<float>(field_.spacing, spot)) +
                    vec3(1.0f, 5.3f * static_cast<float>(options_.seed % 89), 7.0f));
    const float angle = 1.5f * At<float>(field_.tilt, spot) * noise;
    sum = std::cos(angle) * sum + std::sin(angle) * glm::cross(normal, sum);
    sum -= normal * glm::dot(sum, normal);
    // A crease bends no more sharply than cloth does.
    const vec3 before = UnitOr(spot.direction - normal * glm::dot(spot.direction, normal), sum);
    return UnitOr(0.7f * before + 0.3f * UnitOr(sum, before), before);
  }

  // Walks through the spot's triangle. False at a border.
  bool Walk(Spot* spot, float* walked) const {
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
    const std::uint32_t next =
        neighbours_[spot->triangle][static_cast<std::size_t>((exit + 1) % 3)];
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

  [[nodiscard]] Crease::Point PointAt(const Spot& spot) const {
    return {.place = PlaceOf(spot),
            .normal = UnitOr(At<vec3>(normals_, spot), vec3(0, 0, 1)),
            .along = spot.direction,
            .excess = At<float>(excess_, spot),
            .laid = At<float>(field_.excess, spot),
            .spacing = At<float>(field_.spacing, spot)};
  }

  // Follows the field one way from a spot. Returns whether the line joins another crease.
  bool Follow(Spot spot, float longest, std::vector<Crease::Point>* points) const {
    float length = 0.0f, since = 0.0f;
    for (int k = 0; k < kMostWalks; ++k) {
      float walked = 0.0f;
      if (!Walk(&spot, &walked)) return false;
      length += walked;
      since += walked;
      if (since < kStep) continue;
      since = 0.0f;
      const Crease::Point point = PointAt(spot);
      if (point.laid < options_.least || length > longest * point.spacing) return false;
      // A spiral or ring that meets itself.
      for (std::size_t i = 0; i + 20 < points->size(); ++i) {
        if (glm::distance((*points)[i].place, point.place) < 0.8f * point.spacing &&
            glm::dot((*points)[i].normal, point.normal) > kSameSide)
          return false;
      }
      const PointGrid::Entry* nearest = nullptr;
      float least = kMeets * point.spacing;
      PointGrid::Entry found;
      grid_.Near(point.place, least, [&](const PointGrid::Entry& entry) {
        if (glm::dot(entry.normal, point.normal) < kSameSide) return;
        const float distance = glm::distance(entry.place, point.place);
        if (distance >= least) return;
        least = distance;
        found = entry;
        nearest = &found;
      });
      points->push_back(point);
      if (nearest == nullptr) continue;
      if (std::abs(glm::dot(found.along, spot.direction)) < kJoins) return false;
      return true;
    }
    return false;
  }

  void Trace(std::uint32_t v) {
    Spot spot{.triangle = first_triangle_[v], .corners = vec3(0.0f), .direction = field_.along[v]};
    const auto& corners = mesh_.triangles()[spot.triangle].vertices;
    for (int k = 0; k < 3; ++k) {
      if (corners[static_cast<std::size_t>(k)] == v) spot.corners[k] = 1.0f;
    }
    // The line begins inside the triangle, from where all directions lead out.
    spot.corners = 0.9f * spot.corners + vec3(0.1f / 3.0f);
    const float random = RandomAt(static_cast<int>(v), static_cast<int>(options_.seed), 72);
    const float longest = 0.5f * options_.longest * (0.6f + 0.8f * random);
    std::vector<Crease::Point> ahead, behind;
    const bool joins_ahead = Follow(spot, longest, &ahead);
    Spot back = spot;
    back.direction = -back.direction;
    const bool joins_behind = Follow(back, longest, &behind);
    Crease crease;
    for (auto point = behind.rbegin(); point != behind.rend(); ++point) {
      point->along = -point->along;
      crease.points.push_back(*point);
    }
    crease.points.push_back(PointAt(spot));
    crease.points.insert(crease.points.end(), ahead.begin(), ahead.end());
    float length = 0.0f;
    for (std::size_t i = 0; i < crease.points.size(); ++i) {
      const Crease::Point& point = crease.points[i];
      if (i > 0) length += glm::distance(point.place, crease.points[i - 1].place);
      grid_.Add({point.place, point.normal, point.along,
                 static_cast<std::uint32_t>(creases_.size()), length});
    }
    lengths_.push_back(length);
    joins_.push_back({joins_behind, joins_ahead});
    creases_.push_back(std::move(crease));
  }

  // Half the distance to the next crease on each side, smoothed along the crease.
  void MeasureSides() {
    for (std::uint32_t c = 0; c < creases_.size(); ++c) {
      std::vector<Crease::Point>& points = creases_[c].points;
      for (Crease::Point& point : points) {
        const float most = 1.4f * point.spacing;
        float left = most, right = most;
        const vec3 across = glm::cross(point.normal, point.along);
        grid_.Near(point.place, most, [&](const PointGrid::Entry& entry) {
          if (entry.crease == c || glm::dot(entry.normal, point.normal) < kSameSide) return;
          const vec3 step = entry.place - point.place;
          const float side = glm::dot(step, across);
          // Beside, not ahead.
          if (std::abs(side) < 0.7f * glm::length(step)) return;
          float& distance = side > 0.0f ? left : right;
          distance = std::min(distance, std::abs(side));
        });
        point.left = 0.5f * std::max(left, 0.4f * point.spacing);
        point.right = 0.5f * std::max(right, 0.4f * point.spacing);
      }
      for (int pass = 0; pass < 12; ++pass) {
        std::vector<Crease::Point> next = points;
        for (std::size_t i = 1; i + 1 < points.size(); ++i) {
          next[i].left =
              0.25f * points[i - 1].left + 0.5f * points[i].left + 0.25f * points[i + 1].left;
          next[i].right =
              0.25f * points[i - 1].right + 0.5f * points[i].right + 0.25f * points[i + 1].right;
        }
        points.swap(next);
      }
    }
  }

  // Short and lonely creases look like scars.
  void Discard() {
    std::vector<Crease> kept;
    std::vector<std::array<bool, 2>> joins;
    std::vector<float> lengths;
    for (std::size_t c = 0; c < creases_.size(); ++c) {
      const Crease& crease = creases_[c];
      float spacing = 0.0f, excess = 0.0f, alone = 0.0f;
      for (const Crease::Point& point : crease.points) {
        spacing += point.spacing;
        excess = std::max(excess, point.laid);
        alone += std::min(point.left, point.right) > 0.69f * point.spacing ? 1.0f : 0.0f;
      }
      const auto count = static_cast<float>(crease.points.size());
      spacing /= count;
      const float shortest = std::lerp(std::max(kShallow, options_.shortest), options_.shortest,
                                       Smoothstep(0.1f, 0.3f, excess));
      if (lengths_[c] < shortest * spacing) continue;
      if (alone > 0.6f * count && lengths_[c] < kAlone * spacing && excess < 0.3f) continue;
      kept.push_back(crease);
      joins.push_back(joins_[c]);
      lengths.push_back(lengths_[c]);
    }
    creases_ = std::move(kept);
    joins_ = std::move(joins);
    lengths_ = std::move(lengths);
  }

  // Creases swell and shrink along their way.
  [[nodiscard]] float VariedAt(const Crease::Point& point) const {
    const float noise =
        SignedNoise(point.place / (1.2f * point.spacing) +
                    vec3(8.0f, 2.0f, 4.1f * static_cast<float>(options_.seed % 83)));
    return 1.0f - options_.variation * (1.0f - Smoothstep(-0.5f, 0.5f, noise)) * 1.3f;
  }

  // Loose ends fade.
  void Fade() {
    for (std::size_t c = 0; c < creases_.size(); ++c) {
      float length = 0.0f;
      std::vector<Crease::Point>& points = creases_[c].points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0) length += glm::distance(points[i].place, points[i - 1].place);
        // Where a crease joins another, their flanks meet before its end.
        const auto fade = [&](bool joins) {
          return std::min((joins ? kJoint : kFade) * points[i].spacing, 0.45f * lengths_[c]);
        };
        const float first = Smoothstep(0.0f, fade(joins_[c][0]), length);
        const float last = Smoothstep(0.0f, fade(joins_[c][1]), lengths_[c] - length);
        points[i].strength =
            first * last * VariedAt(points[i]) *
            Smoothstep(0.4f * options_.least, 1.2f * options_.least, points[i].excess);
        const std::size_t next = std::min(i + 1, points.size() - 1),
                          before = next > 0 ? next - 1 : 0;
        points[i].along = UnitOr(points[next].place - points[before].place, points[i].along);
      }
    }
  }

  const FineMesh& mesh_;
  const CreaseField& field_;
  std::span<const float> excess_;
  const CreaseOptions& options_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<vec3> normals_;
  std::vector<std::uint32_t> first_triangle_;
  PointGrid grid_;
  std::vector<Crease> creases_;
  std::vector<float> lengths_;
  std::vector<std::array<bool, 2>> joins_;
};

}  // namespace

std::vector<Crease> LayCreases(const FineMesh& mesh, const CreaseField& field,
                               std::span<const float> excess, const CreaseOptions& options) {
  return Layer(mesh, field, excess, options).Lay();
}

}  // namespace furrow::authoring
