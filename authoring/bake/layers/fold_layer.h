// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <glm/vec3.hpp>

#include "authoring/bake/layers/fold_field.h"
#include "authoring/bake/layers/kernels.h"
#include "authoring/bake/layers/profile.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"

namespace furrow::authoring {

// One set of folds. They run perpendicular to the direction of strongest compression, or along that
// direction if `crossing` is set.
class FoldLayer {
 public:
  struct Options {
    BakeMaterial material;
    float wavelength_scale = 1.0f;  // multiplier for the wavelengths of the field, > 0
    bool crossing = false;
    float height = 1.0f;  // multiplier for the height of the folds, >= 0
    std::uint32_t seed = 1;
  };
  // `profile` must outlive the layer; `field` need not. Errors: kLimit (the folds are too fine for
  // the size of the surface), kUnavailable (cancelled by `progress`).
  [[nodiscard]] static Result<std::unique_ptr<FoldLayer>> Create(const FoldField& field,
                                                                 const FoldProfile& profile,
                                                                 const Options& options,
                                                                 BakeProgress* progress);

  // The height and slope of the folds at a point; 0 where no fold reaches. `tangent`, `bitangent`:
  // unit vectors along which the slope is measured. Thread-safe.
  [[nodiscard]] FoldSample At(const SurfacePoint& point, const glm::vec3& tangent,
                              const glm::vec3& bitangent) const;

  [[nodiscard]] std::span<const FoldKernel> kernels() const { return kernels_.kernels(); }

 private:
  FoldLayer(const FoldProfile& profile, KernelSet kernels)
      : profile_(profile), kernels_(std::move(kernels)) {}
  // The factor by which all folds must grow to preserve the arc length, at least 1.
  [[nodiscard]] float HeightCorrection(const FoldField& field, const Options& options) const;

  const FoldProfile& profile_;
  KernelSet kernels_;
  float height_ = 1.0f;  // scales the height of every fold
};

}  // namespace furrow::authoring
