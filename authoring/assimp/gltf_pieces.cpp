// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/gltf_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <glm/gtc/type_precision.hpp>

namespace furrow::authoring {

gltf::Transform InvertibleTransform(const glm::mat4& m) {
  gltf::Transform transform = gltf::Decompose(glm::dmat4(m)).transform;
  for (int i = 0; i < 3; ++i) {
    float& scale = transform.scale[i];
    if (std::abs(scale) < 1e-9f) scale = std::copysign(1e-9f, scale);
  }
  return transform;
}

void AddInfluences(const std::vector<std::vector<Influence>>& influences, gltf::Builder* builder,
                   GltfJson* attributes) {
  std::size_t most = 1;
  for (const auto& list : influences) most = std::max(most, list.size());
  for (std::size_t set = 0; 4 * set < most; ++set) {
    std::vector<glm::u16vec4> joints(influences.size(), glm::u16vec4(0));
    std::vector<glm::vec4> weights(influences.size(), glm::vec4(0.0f));
    for (std::size_t v = 0; v < influences.size(); ++v) {
      for (std::size_t i = 4 * set; i < std::min(influences[v].size(), 4 * set + 4); ++i) {
        joints[v][static_cast<int>(i % 4)] = static_cast<std::uint16_t>(influences[v][i].joint);
        weights[v][static_cast<int>(i % 4)] = influences[v][i].weight;
      }
    }
    using B = gltf::Builder;
    const std::string suffix = "_" + std::to_string(set);
    (*attributes)["JOINTS" + suffix] =
        builder->AddAccessor(joints, B::kUnsignedShort, "VEC4", B::kArrayBuffer);
    (*attributes)["WEIGHTS" + suffix] =
        builder->AddAccessor(weights, B::kFloat, "VEC4", B::kArrayBuffer);
  }
}

}  // namespace furrow::authoring
