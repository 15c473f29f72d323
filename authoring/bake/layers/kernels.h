// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/layers/fold_field.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/surface/surface.h"
#include "base/status.h"

namespace furrow::authoring {

// A wave with limited reach around a point of the surface. Its phase at a nearby position p is
// `phase` + dot(frequency, p - place.position), in radians; valleys are at phase 0.
struct FoldKernel {
  SurfacePoint place;
  // Radians per metre, tangent to the surface and across the fold; the sign is arbitrary.
  glm::vec3 frequency{0.0f};
  float phase = 0.0f;      // at `place`, radians
  float amplitude = 0.0f;  // half the height from valley to ridge, metres
  float reach = 0.0f;      // metres

  // The weight of the kernel at a squared distance: 1 at the centre, falling smoothly to 0 at
  // `reach`.
  [[nodiscard]] float ShareAt(float squared_distance) const {
    const float q = 1.0f - squared_distance / (reach * reach);
    return q > 0.0f ? q * q * q : 0.0f;
  }
};

// The kernels of one set of folds and, for each triangle, a list of the kernels that reach it.
class KernelSet {
 public:
  struct Options {
    float wavelength_scale = 1.0f;  // multiplier for the wavelengths of the field, > 0
    // If true, folds run along FoldParameters::across, with the height for the weaker compression.
    bool crossing = false;
    // Kernels are placed where the compression is at least half of this, and within reach of such
    // places.
    float threshold = 0.02f;
    float variation = 0.0f;  // local variation of the wavelength, [0, 0.5]
    std::uint32_t seed = 1;
  };
  // Half the height of a fold in metres, for a compression and a wavelength in metres.
  using Amplitude = std::function<float(float compression, float wavelength)>;

  // Places kernels about half a wavelength apart wherever there are folds, and far enough around
  // them for the folds to fade out. All phases are 0. Errors: kLimit (the folds are too fine for
  // the size of the surface and would need millions of kernels), kUnavailable (cancelled).
  [[nodiscard]] static Result<KernelSet> Create(const FoldField& field, const Options& options,
                                                const Amplitude& amplitude, BakeProgress* progress);

  [[nodiscard]] std::vector<FoldKernel>& kernels() { return kernels_; }
  [[nodiscard]] std::span<const FoldKernel> kernels() const { return kernels_; }
  // Indices of the kernels that reach a triangle.
  [[nodiscard]] std::span<const std::uint32_t> Reaching(std::uint32_t triangle) const {
    return std::span(lists_).subspan(starts_[triangle], starts_[triangle + 1] - starts_[triangle]);
  }

 private:
  KernelSet() = default;
  Status PlaceKernels(const FoldField& field, const Options& options, const Amplitude& amplitude,
                      BakeProgress* progress);
  void Connect(const Surface& surface, BakeProgress* progress);

  std::vector<FoldKernel> kernels_;
  std::vector<std::uint32_t> lists_;
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::authoring
