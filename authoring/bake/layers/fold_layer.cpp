// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/fold_layer.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "authoring/bake/layers/phases.h"
#include "authoring/bake/surface/compression.h"
#include "base/scalar.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

KernelSet::Options KernelOptions(const FoldLayer::Options& options) {
  return {.wavelength_scale = options.wavelength_scale,
          .crossing = options.crossing,
          .threshold = options.material.threshold,
          .variation = options.material.variation,
          .seed = options.seed};
}

// Half the height of a fold. `share` of the compressed length goes into the arc of the fold. The
// height rises smoothly above the threshold, so folds run out instead of ending abruptly.
KernelSet::Amplitude AmplitudeOf(const FoldLayer::Options& options, const FoldProfile& profile) {
  return [options, &profile](float compression, float wavelength) {
    const BakeMaterial& material = options.material;
    const float begin = material.threshold;
    const float onset = begin > 0.0f ? Smoothstep(begin, 3.0f * begin, compression) : 1.0f;
    return options.height * onset * profile.Amplitude(material.share * compression) * wavelength /
           (2.0f * kPi);
  };
}

// A sample of a fully developed fold.
struct Slope {
  float compression = 0.0f;  // the part of the compression that the fold takes up
  float across = 0.0f;       // dh/dx across the fold, x on the surface at rest
  float weight = 0.0f;
};

// The mean arc length over `slopes`, relative to the surface at rest, with fold heights scaled by
// `factor`.
double MeanArc(const std::vector<Slope>& slopes, float factor) {
  double arc = 0.0, weight = 0.0;
  for (const Slope& slope : slopes) {
    arc +=
        static_cast<double>(slope.weight) * std::hypot(1.0 - static_cast<double>(slope.compression),
                                                       static_cast<double>(factor * slope.across));
    weight += static_cast<double>(slope.weight);
  }
  return weight > 0.0 ? arc / weight : 1.0;
}

// Point `n` of an infinite, evenly spread and repeatable sequence of barycentric coordinates
// (Roberts' R2 sequence). The sequence continues from triangle to triangle: with the same points in
// every triangle, a regular mesh would sample a row of folds at the same few phases.
vec3 CornersOf(std::uint64_t n) {
  const auto place = [n](double step) {
    const double at = 0.5 + step * static_cast<double>(n);
    return static_cast<float>(at - std::floor(at));
  };
  vec2 u(place(0.7548776662466927), place(0.5698402909980532));
  if (u.x + u.y > 1.0f) u = 1.0f - u;
  return {1.0f - u.x - u.y, u.x, u.y};
}

// A value with its derivatives along tangent and bitangent (forward-mode differentiation).
struct Dual {
  float value = 0.0f;
  vec2 slope{0.0f};
};
Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.slope * b.value + b.slope * a.value};
}
Dual operator/(const Dual& a, const Dual& b) {
  const float inverse = 1.0f / b.value;
  return {a.value * inverse, (a.slope - b.slope * (a.value * inverse)) * inverse};
}

// A factor of the height that grows with the agreement of the waves at a point.
Dual Agreement(const Dual& coherence) {
  constexpr float kNone = 0.15f, kFull = 0.6f;
  const float t = Saturate((coherence.value - kNone) / (kFull - kNone));
  return {t * t * (3.0f - 2.0f * t), coherence.slope * (6.0f * t * (1.0f - t) / (kFull - kNone))};
}

// The weighted sum of the waves around a point.
struct WaveSum {
  Dual share, amplitude, x, y;
  float frequency = 0.0f;  // mean length of the frequency, times the weights

  void Add(const Dual& weight, float kernel_amplitude, const vec2& frequency2, float phase) {
    const Dual cosine{std::cos(phase), frequency2 * -std::sin(phase)};
    const Dual sine{std::sin(phase), frequency2 * std::cos(phase)};
    Accumulate(weight, &share);
    Accumulate({weight.value * kernel_amplitude, weight.slope * kernel_amplitude}, &amplitude);
    Accumulate(weight * cosine, &x);
    Accumulate(weight * sine, &y);
    frequency += weight.value * glm::length(frequency2);
  }

  static void Accumulate(const Dual& term, Dual* sum) {
    sum->value += term.value;
    sum->slope += term.slope;
  }
};

// Turns the sum of waves into a fold. Direction (x, y) of the sum is the phase, which the profile
// shapes; its length measures how well the waves agree. Where they cancel, the phase has no
// direction and the fold vanishes.
FoldSample ToFold(const WaveSum& sum, const FoldProfile& profile, float scale) {
  FoldSample fold;
  const float length = std::hypot(sum.x.value, sum.y.value);
  if (!(sum.share.value > 1e-9f) || !(length > 1e-9f * sum.share.value)) return fold;
  const float cosine = sum.x.value / length, sine = sum.y.value / length;
  const Dual modulus{length, sum.x.slope * cosine + sum.y.slope * sine};
  const vec2 phase_slope = (sum.y.slope * cosine - sum.x.slope * sine) / length;
  const FoldProfile::Sample section = profile.At(cosine, sine);
  const Dual shape{section.height, phase_slope * section.slope};
  const Dual height =
      sum.amplitude / sum.share * Agreement(modulus / sum.share) * shape * Dual{scale, vec2(0.0f)};
  fold.height = height.value;
  fold.slope = height.slope;
  fold.cavity =
      CavityOf(height.value, 2.0f * kPi * sum.share.value / std::max(sum.frequency, 1e-6f));
  return fold;
}

}  // namespace

Result<std::unique_ptr<FoldLayer>> FoldLayer::Create(const FoldField& field,
                                                     const FoldProfile& profile,
                                                     const Options& options,
                                                     BakeProgress* progress) {
  Result<KernelSet> kernels =
      KernelSet::Create(field, KernelOptions(options), AmplitudeOf(options, profile), progress);
  FURROW_RETURN_IF_ERROR(kernels);
  PhaseSolver phases(field.surface(), &*kernels);
  phases.Align(progress);
  if (progress->cancelled()) return BakeProgress::CancelledStatus();
  phases.VaryDepth(options.material.variation, options.seed);
  std::unique_ptr<FoldLayer> layer(new FoldLayer(profile, std::move(*kernels)));
  if (!options.crossing && options.wavelength_scale == 1.0f)
    layer->height_ = layer->HeightCorrection(field, options);
  return layer;
}

// Folds are lower than the profile requires where waves from different sides disagree. A common
// factor raises all folds of the layer, so that the surface as a whole keeps its length.
float FoldLayer::HeightCorrection(const FoldField& field, const Options& options) const {
  constexpr float kMax = 1.6f;
  constexpr int kMaxPoints = 48;  // per triangle
  const Surface& surface = field.surface();
  const auto triangles = surface.triangles();
  if (options.height <= 0.0f) return 1.0f;
  std::vector<Slope> slopes;
  std::uint64_t points = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!triangles[t].strain || field.Strongest(t, false) < 3.0f * options.material.threshold) {
      continue;
    }
    const float wavelength = field.Wavelength(surface.PointOf(t, vec3(1.0f / 3.0f)), 1.0f);
    // About 32 samples per square wavelength. The cap bounds the work on large triangles.
    const float wanted = 32.0f * triangles[t].area / (wavelength * wavelength);
    const int count = std::clamp(static_cast<int>(std::ceil(wanted)), 1, kMaxPoints);
    for (int i = 0; i < count; ++i) {
      const SurfacePoint point = surface.PointOf(t, CornersOf(points++));
      const FoldParameters fold = field.At(point);
      if (fold.compression < 3.0f * options.material.threshold) continue;
      // A stroke replaces the folds from strain here.
      if (field.strokes().At(point, fold.across, fold.along).keep < 1.0f) continue;
      const FoldSample sample = At(point, fold.across, fold.along);
      slopes.push_back({options.material.share * fold.compression, sample.slope.x / options.height,
                        triangles[t].area / static_cast<float>(count)});
    }
  }
  if (slopes.empty() || MeanArc(slopes, 1.0f) >= 1.0) return 1.0f;
  // Bisection: the arc grows with the height.
  float low = 1.0f, high = kMax;
  for (int step = 0; step < 20; ++step) {
    const float middle = 0.5f * (low + high);
    (MeanArc(slopes, middle) < 1.0 ? low : high) = middle;
  }
  return low;
}

FoldSample FoldLayer::At(const SurfacePoint& point, const vec3& tangent,
                         const vec3& bitangent) const {
  const auto all = kernels_.kernels();
  const auto reaching = kernels_.Reaching(point.triangle);
  // A wave has no sign: f and -f describe the same folds. The leading direction, which is
  // continuous over the surface, decides which phases are negated.
  Tensor2 directions;
  for (const std::uint32_t k : reaching) {
    const vec3 step = point.position - all[k].place.position;
    const float share = all[k].ShareAt(glm::dot(step, step));
    if (share <= 0.0f) continue;
    const vec2 f(glm::dot(all[k].frequency, tangent), glm::dot(all[k].frequency, bitangent));
    directions = directions + share * Tensor2{f.x * f.x, f.x * f.y, f.y * f.y};
  }
  if (directions.xx + directions.yy <= 0.0f) return {};
  const vec2 leading = PrincipalOf(directions).direction;

  WaveSum sum;
  for (const std::uint32_t k : reaching) {
    const FoldKernel& kernel = all[k];
    const vec3 step = point.position - kernel.place.position;
    // The kernel's ShareAt(), q^3, written out here because its derivative is needed too.
    const float q = 1.0f - glm::dot(step, step) / (kernel.reach * kernel.reach);
    if (q <= 0.0f) continue;
    const vec2 f(glm::dot(kernel.frequency, tangent), glm::dot(kernel.frequency, bitangent));
    const float lead = glm::dot(f, leading);
    // Waves across the leading direction fade out, so that their arbitrary sign cannot tear the
    // surface.
    const float alignment = lead * lead / std::max(glm::dot(f, f), 1e-12f);
    const vec2 step2(glm::dot(step, tangent), glm::dot(step, bitangent));
    const Dual weight{alignment * q * q * q,
                      step2 * (-6.0f * alignment * q * q / (kernel.reach * kernel.reach))};
    const float turn = lead < 0.0f ? -1.0f : 1.0f;
    const float phase = turn * (kernel.phase + glm::dot(kernel.frequency, step));
    sum.Add(weight, kernel.amplitude, turn * f, phase);
  }
  return ToFold(sum, profile_, height_);
}

}  // namespace furrow::authoring
