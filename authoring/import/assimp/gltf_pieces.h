// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/gltf_builder.h"
#include "wrinkle/skeleton/transform.h"

// Helpers to write glTF from another format.
namespace furrow::authoring {

using GltfJson = character::GltfBuilder::Json;

// The nearest transform without shear. Axes of zero length become very small.
[[nodiscard]] wrinkle::Transform WithoutShear(const glm::mat4& m);

[[nodiscard]] GltfJson NodeJson(const std::string& name, const wrinkle::Transform& t);

struct Influence {
  std::size_t joint;  // index in the skin
  float weight;
};

// Adds JOINTS_n and WEIGHTS_n, with enough sets of four for the vertex with the most influences.
void AddInfluences(const std::vector<std::vector<Influence>>& influences,
                   character::GltfBuilder* builder, GltfJson* attributes);

}  // namespace furrow::authoring
