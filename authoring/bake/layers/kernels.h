// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/layers/fold_field.h"
#include "authoring/bake/pace.h"
#include "authoring/bake/surface/surface.h"
#include "base/status.h"

namespace furrow::character::bake {

// A wave of limited reach that stands on the surface: phase + dot(frequency, p - position) near it.
struct FoldKernel {
  SurfacePoint place;
  glm::vec3 frequency{0.0f};  // radians a metre, in the surface, across the fold; its sign is free
  float phase = 0.0f;         // at `place`, radians
  float amplitude = 0.0f;     // metres, of the unit profile
  float reach = 0.0f;         // metres

  // Its share of a point at a squared distance: 1 at its place, 0 and smooth at the reach.
  [[nodiscard]] float ShareAt(float squared_distance) const {
    const float q = 1.0f - squared_distance / (reach * reach);
    return q > 0.0f ? q * q * q : 0.0f;
  }
};

// The kernels of one set of folds, and which of them reach each triangle.
class KernelSet {
 public:
  struct Options {
    float wavelength_scale = 1.0f;  // of the field's
    bool crossing = false;          // folds along the field's `across`, of its weaker compression
    float threshold = 0.02f;        // places with less than half of this have no kernels nearby
    float variation = 0.0f;         // of the wavelength, from place to place
    std::uint32_t seed = 1;
  };
  // Metres of half a fold's height for (compression, wavelength).
  using Amplitude = std::function<float(float compression, float wavelength)>;

  // Kernels about half a wavelength apart, evenly strewn, wherever folds are or could fade into;
  // their phases are 0. kLimit: folds so fine on a surface so large that there would be millions.
  // kUnavailable: stopped.
  [[nodiscard]] static Result<KernelSet> Create(const FoldField& field, const Options& options,
                                                const Amplitude& amplitude, Pace* pace);

  [[nodiscard]] std::vector<FoldKernel>& kernels() { return kernels_; }
  [[nodiscard]] std::span<const FoldKernel> kernels() const { return kernels_; }
  [[nodiscard]] std::span<const std::uint32_t> Reaching(std::uint32_t triangle) const {
    return std::span(lists_).subspan(starts_[triangle], starts_[triangle + 1] - starts_[triangle]);
  }

 private:
  KernelSet() = default;
  Status Strew(const FoldField& field, const Options& options, const Amplitude& amplitude,
               Pace* pace);
  void Connect(const Surface& surface, Pace* pace);

  std::vector<FoldKernel> kernels_;
  std::vector<std::uint32_t> lists_;
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::character::bake
