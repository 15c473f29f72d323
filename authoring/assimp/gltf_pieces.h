// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>

#include "gltf/scene/transform.h"
#include "gltf/write/builder.h"

// Helpers to write glTF from another format.
namespace furrow::authoring {

using GltfJson = gltf::Builder::Json;

// Splits a matrix into translation, rotation and scale. Scales smaller than 1e-9 become 1e-9, so
// the result can be inverted.
[[nodiscard]] gltf::Transform InvertibleTransform(const glm::mat4& m);

// One joint that moves a vertex.
struct Influence {
  std::size_t joint;  // index in the skin
  float weight;       // [0, 1]
};

// Adds the attributes JOINTS_n and WEIGHTS_n to `attributes` and their data to `builder`, with
// enough sets of four for the vertex with the most influences. `influences` has one list per
// vertex.
void AddInfluences(const std::vector<std::vector<Influence>>& influences, gltf::Builder* builder,
                   GltfJson* attributes);

}  // namespace furrow::authoring
