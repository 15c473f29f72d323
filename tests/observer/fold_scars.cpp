// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_scars.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "authoring/bake/surface/compression.h"

namespace furrow::observer {
namespace {

using authoring::PrincipalOf;
using authoring::Tensor2;
using glm::vec2;
using glm::vec3;

constexpr float kFacing = 0.3f;  // cosine between the normals of neighbours
// against
constexpr float kLeastCompression = 0.06f;
constexpr float kClear = 1.5f;  // the strongest compression, relative to that across it
// disordered
constexpr double kOrderWavelengths = 2.0;
constexpr float kLeastOrder = 0.6f;
// isolated, short_deep
constexpr double kFurrowDepth = 0.02;
constexpr double kNeighbour = 1.5;
constexpr double kLongFurrow = 4.0;
constexpr double kShortFurrow = 2.0;
constexpr double kDeepFurrow = 0.1;
constexpr float kTouching = 2.5f;  // distance of connected places, in sides of a square place
// hard
constexpr float kLeastRidge = 0.01f;     // millimetres; lower places count as flat
constexpr double kLeastRadius = 1.0;     // millimetres
constexpr double kRadiusSupport = 0.75;  // millimetres around a place, for its curvature
constexpr float kLeastSupport = 2.2f;    // of it, in sides of the place

float SideOf(const FoldPlace& place) { return std::sqrt(place.area); }

double WeightOf(const FoldPlace& place) {
  return static_cast<double>(place.area * glm::dot(place.slope, place.slope));
}

// Finds places near a point.
class Grid {
 public:
  // `cell`: millimetres, at least the largest radius that is asked for.
  Grid(std::span<const FoldPlace> places, double cell)
      : places_(places), cell_(static_cast<float>(cell)) {
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      cells_[Key(Cell(places[i].position))].push_back(i);
    }
  }

  // Calls `function` with the index of every place within `radius` of a place that faces the same
  // side, itself included.
  template <class Function>
  void ForEachNear(const FoldPlace& centre, double radius, const Function& function) const {
    const glm::ivec3 cell = Cell(centre.position);
    const auto limit = static_cast<float>(radius * radius);
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto found = cells_.find(Key(cell + step));
      if (found == cells_.end()) continue;
      for (const std::uint32_t k : found->second) {
        const vec3 away = places_[k].position - centre.position;
        if (glm::dot(away, away) > limit) continue;
        if (glm::dot(places_[k].normal, centre.normal) > kFacing) function(k);
      }
    }
  }

 private:
  [[nodiscard]] glm::ivec3 Cell(const vec3& p) const { return glm::ivec3(glm::floor(p / cell_)); }
  static std::uint64_t Key(const glm::ivec3& cell) {
    const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & 0x1fffffu; };
    return part(cell.x) | part(cell.y) << 21 | part(cell.z) << 42;
  }

  std::span<const FoldPlace> places_;
  float cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// Directions in the surface at a place, as 2D vectors.
class Frame {
 public:
  explicit Frame(const vec3& normal) {
    const vec3 side = std::abs(normal.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    x_ = glm::normalize(glm::cross(side, normal));
    y_ = glm::cross(normal, x_);
  }
  [[nodiscard]] vec2 Of(const vec3& v) const { return {glm::dot(v, x_), glm::dot(v, y_)}; }

 private:
  vec3 x_, y_;
};

double Share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

void MeasureDirections(std::span<const FoldPlace> places, ScarMeasures* measures) {
  double against = 0.0, drawn_against = 0.0, all = 0.0;
  for (const FoldPlace& place : places) {
    if (place.compression < kLeastCompression) continue;
    if (place.compression < kClear * place.crossing) continue;
    const double weight = WeightOf(place);
    const float along = glm::dot(place.slope, place.direction);
    all += weight;
    if (2.0f * along * along >= glm::dot(place.slope, place.slope)) continue;
    (place.drawn ? drawn_against : against) += weight;
  }
  measures->against = Share(against, all);
  measures->drawn_against = Share(drawn_against, all);
}

// The agreement of the directions around a place, [0, 1], without what strokes draw there.
float OrderAt(std::span<const FoldPlace> places, const Grid& grid, const FoldPlace& place,
              double radius) {
  const Frame frame(place.normal);
  Tensor2 sum;
  grid.ForEachNear(place, radius, [&](std::uint32_t k) {
    if (places[k].drawn) return;
    const vec2 slope = frame.Of(places[k].slope);
    sum = sum + places[k].area * Tensor2{slope.x * slope.x, slope.x * slope.y, slope.y * slope.y};
  });
  const authoring::Principal2 principal = PrincipalOf(sum);
  const float whole = principal.large + principal.small;
  return whole > 0.0f ? (principal.large - principal.small) / whole : 1.0f;
}

double ShareDisordered(std::span<const FoldPlace> places, double wavelength) {
  const double radius = kOrderWavelengths * wavelength;
  const Grid grid(places, radius);
  double disordered = 0.0, all = 0.0;
  // The order varies slowly, so every third place of the list is enough.
  for (std::size_t i = 0; i < places.size(); i += 3) {
    const double weight = WeightOf(places[i]);
    if (weight <= 0.0) continue;
    all += weight;
    if (!places[i].drawn && OrderAt(places, grid, places[i], radius) < kLeastOrder)
      disordered += weight;
  }
  return Share(disordered, all);
}

struct Furrow {
  std::vector<std::uint32_t> places;
  double length = 0.0;
  double depth = 0.0;
  bool drawn = false;
};

// The extent of places along the direction in which they extend furthest, by the power method.
double ExtentOf(std::span<const FoldPlace> all, std::span<const std::uint32_t> of) {
  vec3 mean(0.0f);
  for (const std::uint32_t k : of) mean += all[k].position / static_cast<float>(of.size());
  vec3 axis(0.57f, 0.58f, 0.59f);
  for (int step = 0; step < 30; ++step) {
    vec3 next(0.0f);
    for (const std::uint32_t k : of) {
      const vec3 away = all[k].position - mean;
      next += away * glm::dot(away, axis);
    }
    const float length = glm::length(next);
    if (!(length > 0.0f)) return 0.0;
    axis = next / length;
  }
  float low = 0.0f, high = 0.0f;
  for (const std::uint32_t k : of) {
    const float at = glm::dot(all[k].position - mean, axis);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return static_cast<double>(high - low);
}

Furrow MakeFurrow(std::span<const FoldPlace> all, std::vector<std::uint32_t> places) {
  Furrow furrow;
  double drawn = 0.0, area = 0.0;
  for (const std::uint32_t k : places) {
    furrow.depth = std::max(furrow.depth, static_cast<double>(-all[k].height));
    area += static_cast<double>(all[k].area);
    if (all[k].drawn) drawn += static_cast<double>(all[k].area);
  }
  furrow.drawn = 2.0 * drawn >= area;
  furrow.length = ExtentOf(all, places) + static_cast<double>(SideOf(all[places.front()]));
  furrow.places = std::move(places);
  return furrow;
}

constexpr std::uint32_t kNone = 0xffffffffu;

// Finds the furrows. `owners` receives the furrow of each place, or kNone.
std::vector<Furrow> FindFurrows(std::span<const FoldPlace> places, const Grid& grid,
                                double wavelength, std::vector<std::uint32_t>* owners) {
  const auto deep = static_cast<float>(-kFurrowDepth * wavelength);
  owners->assign(places.size(), kNone);
  std::vector<Furrow> furrows;
  for (std::uint32_t first = 0; first < places.size(); ++first) {
    if (places[first].height > deep || (*owners)[first] != kNone) continue;
    const auto name = static_cast<std::uint32_t>(furrows.size());
    std::vector<std::uint32_t> found{first};
    (*owners)[first] = name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const FoldPlace& place = places[found[i]];
      grid.ForEachNear(place, static_cast<double>(kTouching * SideOf(place)), [&](auto k) {
        if (places[k].height > deep || (*owners)[k] != kNone) return;
        (*owners)[k] = name;
        found.push_back(k);
      });
    }
    furrows.push_back(MakeFurrow(places, std::move(found)));
  }
  return furrows;
}

bool HasNeighbour(std::span<const FoldPlace> places, const Grid& grid,
                  std::span<const std::uint32_t> owners, const Furrow& furrow, double radius) {
  const std::uint32_t name = owners[furrow.places.front()];
  return std::ranges::any_of(furrow.places, [&](std::uint32_t k) {
    bool found = false;
    grid.ForEachNear(places[k], radius, [&](std::uint32_t near) {
      found = found || (owners[near] != kNone && owners[near] != name);
    });
    return found;
  });
}

void MeasureFurrows(std::span<const FoldPlace> places, double wavelength, ScarMeasures* measures) {
  const Grid grid(places, kNeighbour * wavelength);
  std::vector<std::uint32_t> owners;
  const std::vector<Furrow> furrows = FindFurrows(places, grid, wavelength, &owners);
  double all = 0.0, isolated = 0.0, short_deep = 0.0;
  for (const Furrow& furrow : furrows) {
    all += furrow.length;
    if (furrow.drawn || furrow.length >= kLongFurrow * wavelength) continue;
    if (!HasNeighbour(places, grid, owners, furrow, kNeighbour * wavelength)) {
      isolated += furrow.length;
    }
    if (furrow.length < kShortFurrow * wavelength && furrow.depth > kDeepFurrow * wavelength) {
      short_deep += furrow.length;
    }
  }
  measures->isolated = Share(isolated, all);
  measures->short_deep = Share(short_deep, all);
}

// The curvature of the height around a place in the direction of its strongest outward bend, per
// millimetre, positive on ridges: the derivative of the slope by a fit of least squares.
float OutwardBend(std::span<const FoldPlace> places, const Grid& grid, const FoldPlace& place,
                  double radius) {
  const Frame frame(place.normal);
  const vec2 here = frame.Of(place.slope);
  Tensor2 spread;                          // sum of d d^T
  float product[2][2] = {{0, 0}, {0, 0}};  // sum of (slope difference) d^T
  grid.ForEachNear(place, radius, [&](std::uint32_t k) {
    const vec2 d = frame.Of(places[k].position - place.position);
    const vec2 change = frame.Of(places[k].slope) - here;
    spread = spread + Tensor2{d.x * d.x, d.x * d.y, d.y * d.y};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) product[i][j] += change[i] * d[j];
    }
  });
  const float determinant = spread.xx * spread.yy - spread.xy * spread.xy;
  if (!(determinant > 1e-12f)) return 0.0f;
  const auto bend = [&](int i, int j) {  // d slope_i / d x_j
    const float* row = product[i];
    return (j == 0 ? row[0] * spread.yy - row[1] * spread.xy
                   : row[1] * spread.xx - row[0] * spread.xy) /
           determinant;
  };
  const Tensor2 outward{-bend(0, 0), -0.5f * (bend(0, 1) + bend(1, 0)), -bend(1, 1)};
  return PrincipalOf(outward).large;
}

double ShareHard(std::span<const FoldPlace> places) {
  float widest = 0.0f;
  for (const FoldPlace& place : places) widest = std::max(widest, SideOf(place));
  const auto support = [](const FoldPlace& place) {
    return std::max(kRadiusSupport, static_cast<double>(kLeastSupport * SideOf(place)));
  };
  const Grid grid(places, std::max(kRadiusSupport, static_cast<double>(kLeastSupport * widest)));
  double hard = 0.0, all = 0.0;
  for (const FoldPlace& place : places) {
    if (place.height < kLeastRidge) continue;
    const auto area = static_cast<double>(place.area);
    all += area;
    const float bend = OutwardBend(places, grid, place, support(place));
    if (static_cast<double>(bend) * kLeastRadius > 1.0) hard += area;
  }
  return Share(hard, all);
}

}  // namespace

bool IsWithin(const ScarMeasures& measures, const ScarMeasures& limits) {
  return measures.against <= limits.against && measures.drawn_against <= limits.drawn_against &&
         measures.disordered <= limits.disordered && measures.isolated <= limits.isolated &&
         measures.short_deep <= limits.short_deep && measures.hard <= limits.hard;
}

ScarMeasures MeasureScars(const FoldPatch& patch) {
  ScarMeasures measures;
  MeasureDirections(patch.places, &measures);
  measures.disordered = ShareDisordered(patch.places, patch.wavelength);
  MeasureFurrows(patch.places, patch.wavelength, &measures);
  measures.hard = ShareHard(patch.places);
  return measures;
}

}  // namespace furrow::observer
