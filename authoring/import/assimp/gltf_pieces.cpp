// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/assimp/gltf_pieces.h"

#include <algorithm>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace furrow::authoring {

wrinkle::Transform WithoutShear(const glm::mat4& m) {
  wrinkle::Transform t;
  t.translation = glm::vec3(m[3]);
  glm::mat3 axes(m);
  for (int i = 0; i < 3; ++i) {
    t.scale[i] = std::max(glm::length(axes[i]), 1e-9f);
    axes[i] /= t.scale[i];
  }
  if (glm::determinant(axes) < 0.0f) {
    t.scale.x = -t.scale.x;
    axes[0] = -axes[0];
  }
  const glm::quat rotation = glm::quat_cast(axes);
  const float length = glm::length(rotation);
  t.rotation = length > 1e-6f ? rotation / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  return t;
}

GltfJson NodeJson(const std::string& name, const wrinkle::Transform& t) {
  return {{"name", name},
          {"translation", {t.translation.x, t.translation.y, t.translation.z}},
          {"rotation", {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w}},
          {"scale", {t.scale.x, t.scale.y, t.scale.z}}};
}

void AddInfluences(const std::vector<std::vector<Influence>>& influences,
                   character::GltfBuilder* builder, GltfJson* attributes) {
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
    using B = character::GltfBuilder;
    const std::string suffix = "_" + std::to_string(set);
    (*attributes)["JOINTS" + suffix] =
        builder->AddAccessor(joints, B::kUnsignedShort, "VEC4", B::kArrayBuffer);
    (*attributes)["WEIGHTS" + suffix] =
        builder->AddAccessor(weights, B::kFloat, "VEC4", B::kArrayBuffer);
  }
}

}  // namespace furrow::authoring
