// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <unordered_map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/paint/noise.h"
#include "base/scalar.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kSpacing = 0.5f;     // minimum distance of two kernels, wavelengths
constexpr float kReach = 1.7f;       // of a kernel, wavelengths
constexpr float kCandidates = 5.0f;  // candidates tried per kernel that fits
constexpr double kMaxCandidates = 6e6;

// A repeatable number in [0, 1) from a hash, so that a bake does not depend on threads or
// platforms.
float Random(std::uint32_t seed, std::uint32_t a, std::uint32_t b) {
  return HashLattice(static_cast<int>(seed * 7919u + 13u), static_cast<int>(a),
                     static_cast<int>(b));
}

// The triangles that get kernels: folded triangles and those within the reach of a kernel.
std::vector<char> ActiveTriangles(const FoldField& field, const KernelSet::Options& options,
                                  BakeProgress* progress) {
  const Surface& surface = field.surface();
  std::vector<char> active(surface.triangles().size(), 0);
  SurfaceSearch reach(surface);
  for (std::uint32_t t = 0; t < active.size() && progress->ReportStep(t, active.size()); ++t) {
    if (field.Strongest(t, options.crossing) < 0.5f * options.threshold) continue;
    active[t] = 1;
    const SurfacePoint centre = surface.PointOf(t, vec3(1.0f / 3.0f));
    const float wavelength = field.Wavelength(centre, options.wavelength_scale);
    for (const std::uint32_t near : reach.Find(centre.position, {&t, 1}, kReach * wavelength)) {
      active[near] = 1;
    }
  }
  return active;
}

// The direction across the folds with a random deviation that varies over the surface. Folds of
// real skin do not stay parallel for long.
vec3 VariedDirection(const FoldParameters& fold, const KernelSet::Options& options,
                     float wavelength, const vec3& position) {
  constexpr float kStray = 0.9f;  // radians, times `variation`
  const vec3 at = position / (3.0f * wavelength) + static_cast<float>(options.seed) + 31.7f;
  const float angle = kStray * options.variation * (2.0f * ValueNoise(at) - 1.0f);
  const vec3& main = options.crossing ? fold.along : fold.across;
  const vec3& side = options.crossing ? fold.across : fold.along;
  return main * std::cos(angle) + side * std::sin(angle);
}

// Metres, with a random variation over the surface.
float WavelengthAt(const FoldParameters& fold, const SurfacePoint& place,
                   const KernelSet::Options& options) {
  const float base = std::max(fold.wavelength * options.wavelength_scale, fold.smallest);
  // The variation is several folds wide.
  const vec3 at = place.position / (5.0f * base) + static_cast<float>(options.seed);
  const float vary = 1.0f + options.variation * (2.0f * ValueNoise(at) - 1.0f);
  return std::max(base * vary, fold.smallest);
}

struct Candidate {
  float order;
  std::uint32_t index;  // within the triangle
  SurfacePoint place;
};

// The number of candidates per triangle. The fraction is the probability of one more.
std::vector<float> CandidatesWanted(const FoldField& field, const KernelSet::Options& options,
                                    BakeProgress* progress) {
  const Surface& surface = field.surface();
  const std::vector<char> active = ActiveTriangles(field, options, progress);
  std::vector<float> wanted(active.size(), 0.0f);
  for (std::uint32_t t = 0; t < active.size(); ++t) {
    if (!active[t]) continue;
    const SurfacePoint centre = surface.PointOf(t, vec3(1.0f / 3.0f));
    const float spacing = kSpacing * field.Wavelength(centre, options.wavelength_scale);
    wanted[t] = kCandidates * surface.triangles()[t].area / (spacing * spacing);
  }
  return wanted;
}

// Bounds memory and time before any candidate is made: a tiny wavelength on a large surface has no
// natural limit.
Status CheckCount(const std::vector<float>& wanted) {
  double sum = 0.0;
  for (const float count : wanted) sum += static_cast<double>(count);
  if (sum <= kMaxCandidates) return {};
  char text[128];
  std::snprintf(text, sizeof(text),
                "the folds need %.1f million waves, "
                "more than the limit of %.1f million",
                1e-6 * sum / static_cast<double>(kCandidates),
                1e-6 * kMaxCandidates / static_cast<double>(kCandidates));
  return {StatusCode::kLimit, text, "options",
          "increase the wavelength (--skin-wavelength) or reduce --size"};
}

// Dart throwing: candidates in random order, from which PlaceKernels() keeps those that are far
// enough from the kernels before them. Ties are ordered by index, so that sorting is repeatable.
std::vector<Candidate> Candidates(const Surface& surface, const std::vector<float>& wanted,
                                  const KernelSet::Options& options) {
  std::vector<Candidate> candidates;
  for (std::uint32_t t = 0; t < wanted.size(); ++t) {
    if (wanted[t] <= 0.0f) continue;
    const auto count = static_cast<std::uint32_t>(wanted[t] + Random(options.seed, t, 0xffffu));
    for (std::uint32_t k = 0; k < count; ++k) {
      float u = Random(options.seed, t, 3 * k), v = Random(options.seed, t, 3 * k + 1);
      // Folds the unit square onto the triangle, which keeps the density even.
      if (u + v > 1.0f) {
        u = 1.0f - u;
        v = 1.0f - v;
      }
      candidates.push_back(
          {Random(options.seed, t, 3 * k + 2), k, surface.PointOf(t, vec3(1.0f - u - v, u, v))});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.order != b.order) return a.order < b.order;
    return a.place.triangle != b.place.triangle ? a.place.triangle < b.place.triangle
                                                : a.index < b.index;
  });
  return candidates;
}

// Finds kernels near a point with a hashed grid of cells.
class Grid {
 public:
  explicit Grid(float cell) : cell_(cell) {}

  void Add(const vec3& p, std::uint32_t kernel) { cells_[Key(Cell(p))].push_back(kernel); }

  // Returns true if `test` holds for any kernel in the cells around a point.
  template <class Test>
  bool Any(const vec3& p, const Test& test) const {
    const glm::ivec3 cell = Cell(p);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto found = cells_.find(Key(cell + glm::ivec3(dx, dy, dz)));
          if (found == cells_.end()) continue;
          if (std::any_of(found->second.begin(), found->second.end(), test)) return true;
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] glm::ivec3 Cell(const vec3& p) const { return glm::ivec3(glm::floor(p / cell_)); }
  // 21 bits per axis. Cells that differ by a multiple of 2^21 share a list, which costs time but no
  // correctness, because callers test distances.
  static std::uint64_t Key(const glm::ivec3& c) {
    const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & 0x1fffffu; };
    return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
  }

  float cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

Result<KernelSet> KernelSet::Create(const FoldField& field, const Options& options,
                                    const Amplitude& amplitude, BakeProgress* progress) {
  KernelSet set;
  FURROW_RETURN_IF_ERROR(set.PlaceKernels(field, options, amplitude, progress));
  set.Connect(field.surface(), progress);
  if (progress->cancelled()) return BakeProgress::CancelledStatus();
  return set;
}

Status KernelSet::PlaceKernels(const FoldField& field, const Options& options,
                               const Amplitude& amplitude, BakeProgress* progress) {
  const std::vector<float> wanted = CandidatesWanted(field, options, progress);
  if (progress->cancelled()) return BakeProgress::CancelledStatus();
  FURROW_RETURN_IF_ERROR(CheckCount(wanted));
  const std::vector<Candidate> candidates = Candidates(field.surface(), wanted, options);
  std::vector<float> wavelengths;
  float longest = 0.0f;
  for (const Candidate& candidate : candidates) {
    if (!progress->ReportStep(wavelengths.size(), candidates.size()))
      return BakeProgress::CancelledStatus();
    wavelengths.push_back(WavelengthAt(field.At(candidate.place), candidate.place, options));
    longest = std::max(longest, wavelengths.back());
  }
  // Cells of the largest spacing: all kernels that may be too close lie in the 27 cells around a
  // point.
  Grid grid(std::max(kSpacing * longest, 1e-6f));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!progress->ReportStep(i, candidates.size())) return BakeProgress::CancelledStatus();
    const SurfacePoint& place = candidates[i].place;
    const vec3 normal = field.surface().triangles()[place.triangle].axes.normal;
    const float spacing = kSpacing * wavelengths[i];
    // Closed lips touch each other, so kernels that face the other way do not count.
    const bool taken = grid.Any(place.position, [&](std::uint32_t k) {
      const FoldKernel& other = kernels_[k];
      const vec3 facing = field.surface().triangles()[other.place.triangle].axes.normal;
      return glm::distance(other.place.position, place.position) < spacing &&
             glm::dot(facing, normal) > 0.0f;
    });
    if (taken) continue;
    const FoldParameters fold = field.At(place);
    FoldKernel kernel;
    kernel.place = place;
    kernel.frequency = VariedDirection(fold, options, wavelengths[i], place.position) *
                       (2.0f * kPi / wavelengths[i]);
    kernel.amplitude =
        amplitude(options.crossing ? fold.crossing : fold.compression, wavelengths[i]);
    kernel.reach = kReach * wavelengths[i];
    grid.Add(place.position, static_cast<std::uint32_t>(kernels_.size()));
    kernels_.push_back(kernel);
  }
  return {};
}

// Lists the kernels by triangle in one array with starts, so that texels find them without
// searching. The search runs over the surface, so a kernel does not reach from one lip to the
// other.
void KernelSet::Connect(const Surface& surface, BakeProgress* progress) {
  std::vector<std::vector<std::uint32_t>> lists(surface.triangles().size());
  SurfaceSearch reach(surface);
  for (std::uint32_t k = 0; k < kernels_.size() && progress->ReportStep(k, kernels_.size()); ++k) {
    const FoldKernel& kernel = kernels_[k];
    for (const std::uint32_t t :
         reach.Find(kernel.place.position, {&kernel.place.triangle, 1}, kernel.reach)) {
      lists[t].push_back(k);
    }
  }
  starts_.assign(1, 0);
  for (const auto& list : lists) {
    lists_.insert(lists_.end(), list.begin(), list.end());
    starts_.push_back(lists_.size());
  }
}

}  // namespace furrow::authoring
