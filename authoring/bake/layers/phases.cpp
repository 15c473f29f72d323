// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/phases.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <glm/geometric.hpp>

#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr int kRelaxations = 24;

}  // namespace

// Lists for each kernel the kernels that reach it, and what their waves predict for its phase.
PhaseSolver::PhaseSolver(const Surface& surface, KernelSet* set) : set_(*set) {
  const auto kernels = set_.kernels();
  float strongest = 1e-12f;
  for (const FoldKernel& kernel : kernels) strongest = std::max(strongest, kernel.amplitude);
  starts_.push_back(0);
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const FoldKernel& here = kernels[i];
    const vec3 normal = surface.triangles()[here.place.triangle].axes.normal;
    for (const std::uint32_t j : set_.Reaching(here.place.triangle)) {
      const FoldKernel& there = kernels[j];
      const vec3 step = here.place.position - there.place.position;
      const float share = there.ShareAt(glm::dot(step, step));
      if (j == i || share <= 0.0f) continue;
      // The neighbour's frequency, projected into the surface here.
      vec3 carried = there.frequency - normal * glm::dot(there.frequency, normal);
      const float length = glm::length(carried);
      if (length < 1e-6f) continue;
      carried *= glm::length(there.frequency) / length;
      const float cosine =
          glm::dot(carried, here.frequency) / (glm::length(carried) * glm::length(here.frequency));
      const float turn = cosine < 0.0f ? -1.0f : 1.0f;
      // On a curved surface the mean of both frequencies is accurate to second order.
      const float shift = 0.5f * glm::dot(here.frequency + turn * there.frequency, step);
      const float weight = share * cosine * cosine * (there.amplitude + 0.02f * strongest);
      neighbours_.push_back({j, weight, turn, shift});
    }
    starts_.push_back(neighbours_.size());
  }
}

// The mean of the known neighbours' predictions as a direction, because angles wrap around. False:
// no neighbour is known.
bool PhaseSolver::PredictPhase(std::size_t kernel, const std::vector<char>& known,
                               float* phase) const {
  float x = 0.0f, y = 0.0f;
  for (const Neighbour& neighbour : Of(kernel)) {
    if (!known[neighbour.kernel]) continue;
    const float said = neighbour.turn * set_.kernels()[neighbour.kernel].phase + neighbour.shift;
    x += neighbour.share * std::cos(said);
    y += neighbour.share * std::sin(said);
  }
  if (x == 0.0f && y == 0.0f) return false;
  *phase = std::atan2(y, x);
  return true;
}

void PhaseSolver::Grow() {
  std::vector<FoldKernel>& kernels = set_.kernels();
  struct Entry {
    float priority;
    std::uint32_t kernel;
    bool operator<(const Entry& other) const {
      return priority != other.priority ? priority < other.priority : kernel > other.kernel;
    }
  };
  std::priority_queue<Entry> front;
  std::vector<char> known(kernels.size(), 0);
  std::vector<float> support(kernels.size(), 0.0f);
  // Every kernel starts in the queue, strongest first, but below all kernels that have a known
  // neighbour.
  for (std::uint32_t i = 0; i < kernels.size(); ++i) front.push({kernels[i].amplitude - 1e6f, i});
  while (!front.empty()) {
    const std::uint32_t i = front.top().kernel;
    front.pop();
    // A kernel is queued again whenever its support grows; only its first entry out counts.
    if (known[i]) continue;
    float phase = 0.0f;
    if (PredictPhase(i, known, &phase)) kernels[i].phase = phase;
    known[i] = 1;
    for (const Neighbour& neighbour : Of(i)) {
      const std::uint32_t j = neighbour.kernel;
      if (known[j]) continue;
      support[j] += neighbour.share * (kernels[i].amplitude + kernels[j].amplitude);
      front.push({support[j], j});
    }
  }
}

void PhaseSolver::Align(BakeProgress* progress) {
  Grow();
  std::vector<FoldKernel>& kernels = set_.kernels();
  const std::vector<char> all(kernels.size(), 1);
  for (int pass = 0; pass < kRelaxations; ++pass) {
    if (!progress->Report(static_cast<float>(pass) / static_cast<float>(kRelaxations))) return;
    for (std::size_t i = 0; i < kernels.size(); ++i) {
      float phase = 0.0f;
      if (PredictPhase(i, all, &phase)) kernels[i].phase = phase;
    }
  }
}

// Noise that is smooth along a fold but not across it: neighbouring folds differ in depth, and no
// single fold is beaded.
void PhaseSolver::VaryDepth(float variation, std::uint32_t seed) {
  constexpr int kPasses = 5;
  std::vector<FoldKernel>& kernels = set_.kernels();
  if (variation <= 0.0f || kernels.empty()) return;
  std::vector<float> noise(kernels.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = HashLattice(static_cast<int>(i), static_cast<int>(seed), 77) - 0.5f;
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<float> smooth(noise.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
      float sum = noise[i], total = 1.0f;
      for (const Neighbour& neighbour : Of(i)) {
        const vec3 step = kernels[i].place.position - kernels[neighbour.kernel].place.position;
        // In radians across the fold: the weight vanishes within a third of a wavelength.
        const float across = glm::dot(step, kernels[i].frequency);
        const float share = std::exp(-1.2f * across * across);
        sum += share * noise[neighbour.kernel];
        total += share;
      }
      smooth[i] = sum / total;
    }
    noise = std::move(smooth);
  }
  double square = 0.0;
  for (const float value : noise) square += static_cast<double>(value) * value;
  const float deviation =
      std::max(static_cast<float>(std::sqrt(square / static_cast<double>(noise.size()))), 1e-9f);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const float bounded = std::tanh(noise[i] / deviation);
    kernels[i].amplitude *= std::max(1.0f + 2.0f * variation * bounded, 0.0f);
  }
}

}  // namespace furrow::authoring
