// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/gltf_builder.h"
#include "wrinkle/skeleton/transform.h"

// Pieces of a glTF that is written from another format.
namespace furrow::authoring {

using GltfJson = character::GltfBuilder::Json;

// The nearest transform without the shear that a file may have; axes of no length become tiny.
[[nodiscard]] wrinkle::Transform WithoutShear(const glm::mat4& m);

[[nodiscard]] GltfJson NodeJson(const std::string& name, const wrinkle::Transform& t);

struct Influence {
  std::size_t joint;  // of the skin
  float weight;
};

// JOINTS_n and WEIGHTS_n, as many sets of four as the vertex with most influences needs.
void AddInfluences(const std::vector<std::vector<Influence>>& influences,
                   character::GltfBuilder* builder, GltfJson* attributes);

}  // namespace furrow::authoring
