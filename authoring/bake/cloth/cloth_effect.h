// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "authoring/bake/request/fabric.h"
#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// Cloth as it is cut and worn, on the vertices of a mesh.
struct WornCloth {
  std::vector<glm::mat4> cut;    // skin matrices of the pose that it was cut for
  std::vector<float> room;       // where a pose may move it, [0, 1]; 0: not at all
  std::vector<ClothEase> eases;  // one per vertex; `feeds` is not used
  FabricFolds fabric;
  float ease = 0.0f;   // mean share by which it is longer than the surface at rest
  float feeds = 1.0f;  // ClothEase::feeds
  std::uint32_t seed = 1;
};

// What a pose does to cloth, per vertex of the mesh.
struct ClothEffect {
  // Symmetric tensors across the normal at rest: cloth along the unit vector d hides the share
  // dot(d, slack d) of its length; less than 0 where it is pulled.
  std::vector<glm::mat3> slack;
  std::vector<float> pressed;  // 1 where cloth is pressed together, 0 elsewhere
  std::vector<float> width;    // from crease to crease, in wavelengths of the fabric
  std::vector<float> height;   // of creases, multiplier
};

// Measures a pose: `bent` are its skin matrices, and `shape_weights` those of the blend shapes, or
// empty. Vertices without room keep their lengths.
[[nodiscard]] ClothEffect MeasureClothEffect(const FineMesh& mesh, const WornCloth& cloth,
                                             std::span<const glm::mat4> bent,
                                             std::span<const float> shape_weights);

}  // namespace furrow::authoring
