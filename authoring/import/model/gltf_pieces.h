// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>

#include "gltf/scene/transform.h"
#include "gltf/write/builder.h"

// Parts of a glTF file that is written from another format.
namespace furrow::character {

// gltf::Decompose() with every scale at least 1e-9 in size, so that the result can be inverted.
[[nodiscard]] gltf::Transform InvertibleTransform(const glm::mat4& m);

struct Influence {
  std::size_t joint;  // index in the skin
  float weight;
};

// Adds the attributes JOINTS_n and WEIGHTS_n, with as many sets of four as the vertex with the most
// influences needs. `influences` has one list per vertex.
void AddInfluences(const std::vector<std::vector<Influence>>& influences, gltf::Builder* builder,
                   gltf::Builder::Json* attributes);

}  // namespace furrow::character
