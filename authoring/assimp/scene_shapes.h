// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <assimp/anim.h>
#include <assimp/scene.h>

#include "base/status.h"

namespace furrow::authoring {

// The curve of one blend shape.
struct ShapeCurve {
  std::string name;
  std::vector<std::pair<double, float>> keys;  // ticks, value; in order

  // The value at a time: linear between keys, the first or last key outside of them.
  [[nodiscard]] float At(double ticks) const;
};

// The time of the last key of a blend shape, in ticks; 0 if there is none.
[[nodiscard]] double LastShapeKey(const aiAnimation& animation);

// The animated blend shapes of an animation, in the order of their meshes. If several meshes have a
// shape of one name, the first counts. Errors: kLimit (motion::kMaxBlendShapes), kSchema (keys that
// are not in order), kNonFinite.
[[nodiscard]] Result<std::vector<ShapeCurve>> ListShapeCurves(const aiScene& scene,
                                                              const aiAnimation& animation);

}  // namespace furrow::authoring
