// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/cloth_folds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/layers/parallel_for.h"
#include "authoring/bake/request/fabric.h"
#include "authoring/bake/surface/cloth_slip.h"
#include "authoring/bake/surface/posed_surface.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// Enough for folds to follow a step of the path, and to settle at its end.
constexpr int kIterations = 60;
constexpr int kLastIterations = 3 * kIterations;
// Steps to a pose without a path, for shapes.
constexpr int kShapeSteps = 8;
// Passes that average the heights over about half a fold.
constexpr int kCavityPasses = 24;
// Passes over the result, which remove what is finer than cloth is thick.
constexpr int kSmoothPasses = 1;
// Passes that average over about a fold.
constexpr int kFoldPasses = 48;
// Mean strain of cloth that just hangs, and of cloth that a joint pulls.
constexpr float kHangingStrain = 0.02f;
constexpr float kBentStrain = 0.1f;
// How far a bend pushes cloth along the body, metres: about as far as a limb is thick.
constexpr float kSlipReach = 0.08f;
// The square of a slope that nobody sees.
constexpr float kFlat = 1e-3f;

// The vertices of `mesh` on a posed surface.
std::vector<vec3> PlacesOn(const FineMesh& mesh, std::span<const PosedVertex> surface) {
  std::vector<vec3> welded, places;
  for (const PosedVertex& vertex : surface) welded.push_back(vertex.position);
  for (const FineMesh::Vertex& vertex : mesh.vertices()) {
    places.push_back(vertex.Interpolate(std::span<const vec3>(welded)));
  }
  return places;
}

}  // namespace

void ClothFolds::Add(const BakePose& pose, std::span<const float> mask, float wavelength,
                     const ClothEase& ease) {
  std::vector<SkinMatrices> path = pose.path;
  // Without a path, the pose is reached from rest.
  if (path.empty()) {
    path.emplace_back(pose.skin_matrices.size(), glm::mat4(1.0f));
    for (int k = 0; k < kShapeSteps; ++k) path.push_back(pose.skin_matrices);
  }
  const auto same = [&](const Pose& other) {
    return other.wavelength == wavelength && other.path == path &&
           other.shape_weights == pose.shape_weights;
  };
  auto found = std::ranges::find_if(poses_, same);
  if (found == poses_.end()) {
    found = poses_.insert(found, {.path = std::move(path),
                                  .shape_weights = pose.shape_weights,
                                  .room = std::vector<float>(mesh_.vertices().size(), 0.0f),
                                  .shares = std::vector<float>(mesh_.vertices().size(), 0.0f),
                                  .wavelength = wavelength,
                                  .eases = std::vector<ClothEase>(mesh_.vertices().size()),
                                  .wider = {},
                                  .folds = {}});
  }
  for (std::size_t v = 0; v < mesh_.vertices().size(); ++v) {
    const float inside = mesh_.vertices()[v].Interpolate(mask);
    found->room[v] = std::max(found->room[v], inside);
    found->shares[v] = std::max(found->shares[v], inside * pose.weight);
    ClothEase& here = found->eases[v];
    here.looser = std::max(here.looser, std::lerp(1.0f, ease.looser, inside));
    here.least = std::max(here.least, inside * ease.least);
  }
}

// The vertices of the mesh at the end of the pose's path.
std::vector<vec3> ClothFolds::LastPlaces(const Pose& pose) const {
  const Surface& surface = mesh_.surface();
  const std::vector<vec3> morphed =
      pose.shape_weights.empty() ? std::vector<vec3>() : surface.Morphed(pose.shape_weights);
  return PlacesOn(mesh_, PoseSurface(surface, pose.path.back(),
                                     morphed.empty() ? surface.positions() : std::span(morphed)));
}

// Per vertex of the mesh: how much wider than beside a bent joint folds are. A bend also pulls and
// presses the cloth that it pushes along the body.
std::vector<float> ClothFolds::WiderWhereHanging(std::span<const vec3> cut,
                                                 std::span<const vec3> bent,
                                                 std::span<const glm::mat3> slipped) const {
  std::vector<float> strains(mesh_.vertices().size(), 0.0f);
  for (const auto& edge : mesh_.edges()) {
    const float before = std::max(glm::distance(cut[edge[0]], cut[edge[1]]), 1e-9f);
    const float after = glm::distance(bent[edge[0]], bent[edge[1]]);
    const float strain = std::min(std::abs(after / before - 1.0f), 1.0f);
    for (const std::uint32_t end : edge) {
      const glm::mat3& gain = slipped[end];
      strains[end] += (strain + gain[0][0] + gain[1][1] + gain[2][2]) /
                      static_cast<float>(mesh_.Around(end).size());
    }
  }
  Smooth(&strains, kFoldPasses);
  const float most = HangingWidth();
  for (float& strain : strains) {
    strain = std::lerp(most, 1.0f, Smoothstep(kHangingStrain, kBentStrain, strain));
  }
  return strains;
}

template <class Step>
void ClothFolds::SolvePose(Pose* pose, const Step& step) const {
  const Surface& surface = mesh_.surface();
  const std::vector<vec3> cut =
      PlacesOn(mesh_, PoseSurface(surface, pose->path.front(), surface.positions()));
  const std::vector<vec3> bent = LastPlaces(*pose);
  const std::vector<glm::mat3> slipped = SlippedLength(mesh_, cut, bent, pose->room, kSlipReach);
  pose->wider = WiderWhereHanging(cut, bent, slipped);
  WrinkleMesh cloth(mesh_, pose->room,
                    {.wavelength = pose->wavelength,
                     .ease = ease_,
                     .seed = seed_,
                     .wider = pose->wider,
                     .eases = pose->eases,
                     .slipped = slipped});
  const std::vector<SkinMatrices>& path = pose->path;
  std::vector<float> weights = pose->shape_weights;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const bool last = k + 1 == path.size();
    const float t =
        static_cast<float>(k) / static_cast<float>(std::max<std::size_t>(path.size() - 1, 1));
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = t * pose->shape_weights[i];
    const std::vector<vec3> morphed =
        weights.empty() ? std::vector<vec3>() : surface.Morphed(weights);
    const std::span<const vec3> positions =
        weights.empty() ? surface.positions() : std::span<const vec3>(morphed);
    cloth.Step(PoseSurface(surface, path[k], positions), last ? kLastIterations : kIterations, t);
    if (!step()) return;
  }
  pose->folds = cloth.Folds();
  pose->path.clear();
}

bool ClothFolds::Solve(int threads, BakeProgress* progress) {
  std::size_t total = 0;
  for (const Pose& pose : poses_) total += pose.path.size();
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  // Progress is reported by the calling thread alone.
  const auto caller = std::this_thread::get_id();
  const auto step = [&] {
    const std::size_t steps = ++done;
    if (std::this_thread::get_id() == caller &&
        !progress->Report(static_cast<float>(steps) / static_cast<float>(total))) {
      stopped = true;
    }
    return !stopped;
  };
  const auto work = [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last && !stopped; ++p) SolvePose(&poses_[p], step);
  };
  // A pose is long: each is a range of its own.
  const bool solved = ParallelFor(
      poses_.size(), threads, work, [&](float) { return !stopped; }, 1);
  if (!solved || stopped || !progress->Report(1.0f)) return false;
  Mix();
  return true;
}

std::pair<float, float> ClothFolds::Wavelengths() const {
  if (poses_.empty()) return {0.0f, 0.0f};
  const auto [least, most] = std::ranges::minmax(poses_, {}, &Pose::wavelength);
  return {least.wavelength, most.wavelength};
}

// Per vertex of the mesh: the square of the slopes around it.
std::vector<float> ClothFolds::Prominence(const Pose& pose) const {
  std::vector<float> energy;
  energy.reserve(pose.folds.size());
  for (const WrinkleMesh::Fold& fold : pose.folds) {
    energy.push_back(glm::dot(fold.gradient, fold.gradient));
  }
  Smooth(&energy, kFoldPasses);
  return energy;
}

void ClothFolds::Mix() {
  const std::size_t count = mesh_.vertices().size();
  heights_.assign(count, 0.0f);
  gradients_.assign(count, vec3(0.0f));
  std::vector<float> wavelengths(count, 0.0f);
  std::vector<std::vector<float>> prominence;
  for (const Pose& pose : poses_) prominence.push_back(Prominence(pose));
  for (std::size_t v = 0; v < count; ++v) {
    float sum = 0.0f;
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      const Pose& pose = poses_[p];
      const float energy = prominence[p][v] + kFlat;
      const float share = pose.shares[v] * energy * energy;
      // A weak pose has shallow folds.
      const float deep =
          pose.room[v] > 0.0f ? share * pose.shares[v] / pose.room[v] * depth_ : 0.0f;
      sum += share;
      heights_[v] += deep * pose.folds[v].height;
      gradients_[v] += deep * pose.folds[v].gradient;
      wavelengths[v] += share * pose.wider[v] * pose.wavelength;
    }
    if (sum <= 0.0f) continue;
    heights_[v] /= sum;
    gradients_[v] /= sum;
    wavelengths[v] /= sum;
  }
  Smooth(&heights_, kSmoothPasses);
  Smooth(&gradients_, kSmoothPasses);
  MeasureCavities(wavelengths);
}

// Averages each value with those around it, `passes` times.
template <class T>
void ClothFolds::Smooth(std::vector<T>* values, int passes) const {
  std::vector<T> next(values->size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t v = 0; v < values->size(); ++v) {
      T sum = (*values)[v];
      for (const std::uint32_t other : mesh_.Around(v)) sum += (*values)[other];
      next[v] = sum / static_cast<float>(mesh_.Around(v).size() + 1);
    }
    values->swap(next);
  }
}

// A valley is deep relative to the mean height around it.
void ClothFolds::MeasureCavities(const std::vector<float>& wavelengths) {
  std::vector<float> mean = heights_;
  Smooth(&mean, kCavityPasses);
  cavities_.assign(mean.size(), 1.0f);
  for (std::size_t v = 0; v < mean.size(); ++v) {
    if (wavelengths[v] > 0.0f) cavities_[v] = CavityOf(heights_[v] - mean[v], wavelengths[v]);
  }
}

FoldSample ClothFolds::At(const SurfacePoint& point, const vec3& tangent,
                          const vec3& bitangent) const {
  const FineMesh::Place place = mesh_.Find(point);
  const auto& vertices = mesh_.triangles()[place.triangle].vertices;
  FoldSample fold{.cavity = 0.0f};
  vec3 gradient(0.0f);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = vertices[static_cast<std::size_t>(k)];
    fold.height += place.corners[k] * heights_[v];
    gradient += place.corners[k] * gradients_[v];
    fold.cavity += place.corners[k] * cavities_[v];
  }
  fold.slope = {glm::dot(gradient, tangent), glm::dot(gradient, bitangent)};
  return fold;
}

}  // namespace furrow::authoring
