// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/cell_grid.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr int kMostWalks = 4000;
// A crease ends this near to another, in spacings.
constexpr float kMeets = 0.4f;
// The cosine of the angle at which creases join.
constexpr float kJoins = 0.75f;
// The length over which loose ends fade, in spacings.
constexpr float kFade = 2.5f;
constexpr float kJoint = 0.4f;  // likewise, where it joins another
// The least length of shallow creases, and of creases without neighbours, in spacings.
constexpr float kShallow = 3.5f;
constexpr float kAlone = 4.5f;
constexpr float kStep = 0.005f;  // between points, metres
// The standard deviation over which a crest averages what it hides, in spacings.
constexpr float kPersists = 2.0f;

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
        walk_(mesh, field, options.seed),
        normals_(NormalsOf(mesh)),
        grid_(0.05f) {}

  std::vector<Crease> Lay() {
    std::vector<std::uint32_t> order;
    std::vector<float> rank(mesh_.vertices().size(), 0.0f);
    for (std::uint32_t v = 0; v < rank.size(); ++v) {
      if (field_.excess[v] < options_.start) continue;
      const float noise = RandomAt(static_cast<int>(v), static_cast<int>(options_.seed), 71);
      rank[v] = field_.excess[v] * (0.85f + 0.3f * noise);
      order.push_back(v);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return rank[a] != rank[b] ? rank[a] > rank[b] : a < b;
    });
    for (const std::uint32_t v : order) {
      if (!IsFree(mesh_.positions()[v], normals_[v], SpacingAt(v))) continue;
      if (const std::optional<Spot> start = walk_.StartAt(v)) Trace(v, *start);
    }
    MeasureSides();
    Discard();
    Persist();
    Fade();
    return std::move(creases_);
  }

 private:
  using Spot = CreaseWalk::Spot;

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

  [[nodiscard]] Crease::Point PointAt(const Spot& spot) const {
    return {.place = walk_.PlaceOf(spot),
            .normal = UnitOr(walk_.At(std::span<const vec3>(normals_), spot), vec3(0, 0, 1)),
            .along = spot.direction,
            .excess = walk_.At(excess_, spot),
            .laid = walk_.At(std::span<const float>(field_.excess), spot),
            .spacing = walk_.At(std::span<const float>(field_.spacing), spot)};
  }

  // Follows the field one way from a spot. Returns whether the line joins another crease.
  bool Follow(Spot spot, float longest, std::vector<Crease::Point>* points) const {
    float length = 0.0f, since = 0.0f;
    for (int k = 0; k < kMostWalks; ++k) {
      float walked = 0.0f;
      if (!walk_.Step(&spot, &walked)) return false;
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

  void Trace(std::uint32_t v, const Spot& spot) {
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

  // A crest is stiff along its way: where it leaves the hollow of a bend, it goes on at nearly the
  // same height.
  void Persist() {
    for (std::size_t c = 0; c < creases_.size(); ++c) {
      std::vector<Crease::Point>& points = creases_[c].points;
      if (points.size() < 2) continue;
      float spacing = 0.0f;
      for (const Crease::Point& point : points) spacing += point.spacing;
      const auto count = static_cast<float>(points.size());
      const float step = lengths_[c] / (count - 1.0f);
      // A pass adds half a squared step to the variance. More passes than that leave the mean.
      const float steps = std::min(kPersists * spacing / (count * std::max(step, 1e-6f)), count);
      const int passes = static_cast<int>(2.0f * steps * steps);
      std::vector<float> now, next;
      for (const Crease::Point& point : points) now.push_back(point.excess);
      next = now;
      for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < now.size(); ++i) {
          const float before = now[i > 0 ? i - 1 : 0], after = now[std::min(i + 1, now.size() - 1)];
          next[i] = 0.25f * before + 0.5f * now[i] + 0.25f * after;
        }
        now.swap(next);
      }
      for (std::size_t i = 0; i < points.size(); ++i) points[i].excess = now[i];
    }
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
  CreaseWalk walk_;
  std::vector<vec3> normals_;
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
