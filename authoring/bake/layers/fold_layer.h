// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <glm/vec3.hpp>

#include "authoring/bake/bake.h"
#include "authoring/bake/layers/fold_field.h"
#include "authoring/bake/layers/kernels.h"
#include "authoring/bake/layers/profile.h"
#include "authoring/bake/pace.h"

namespace furrow::character::bake {

// One set of folds across (or, crossing, along) the compression of a surface.
class FoldLayer {
 public:
  struct Options {
    BakeMaterial material;
    float wavelength_scale = 1.0f;
    bool crossing = false;
    float height = 1.0f;  // scales the height
    std::uint32_t seed = 1;
  };
  // `profile` outlives the layer. Errors: KernelSet::Create()'s.
  [[nodiscard]] static Result<std::unique_ptr<FoldLayer>> Create(const FoldField& field,
                                                                 const FoldProfile& profile,
                                                                 const Options& options,
                                                                 Pace* pace);

  // Safe from several threads. Zero where no fold reaches.
  [[nodiscard]] FoldSample At(const SurfacePoint& point, const glm::vec3& tangent,
                              const glm::vec3& bitangent) const;

  [[nodiscard]] std::span<const FoldKernel> kernels() const { return kernels_.kernels(); }

 private:
  FoldLayer(const FoldProfile& profile, KernelSet kernels)
      : profile_(profile), kernels_(std::move(kernels)) {}
  // The height that all folds together are short of what keeps the arc's length, as a factor.
  [[nodiscard]] float MissingHeight(const FoldField& field, const Options& options) const;

  const FoldProfile& profile_;
  KernelSet kernels_;
  float height_ = 1.0f;  // scales every fold
};

}  // namespace furrow::character::bake
