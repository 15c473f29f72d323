// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/bake/layers/stroke_layer.h"

namespace furrow::authoring {

// The skin's own structure in its folds. Skin is a net of lines about 1 mm apart. A fold of skin
// therefore has no smooth flanks: its height h changes from cell to cell, and small lines cross it.
// Without them folds look like ridges of plastic. The grain adds
//
//   strength * sum over sizes s of share(s) * noise(position / s) * h * c / (c + |h|),  c = s / 4
//
// Shallow folds vary by a share of their height. On deep ones the grain stays as high as skin is
// rough, so that they do not look torn.
class SkinGrain {
 public:
  explicit SkinGrain(float strength) : strength_(strength) {}  // [0, 1]; 0 changes nothing

  // The fold at `position` (metres) with grain. Slopes stay the exact derivatives along the unit
  // vectors `tangent` and `bitangent`. `smallest`: the shortest wavelength that the texels can
  // show, metres; finer structure is left out.
  [[nodiscard]] FoldSample Apply(const FoldSample& fold, const glm::vec3& position,
                                 const glm::vec3& tangent, const glm::vec3& bitangent,
                                 float smallest) const;

 private:
  float strength_;
};

}  // namespace furrow::authoring
