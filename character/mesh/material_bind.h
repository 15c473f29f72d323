// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "character/mesh/mesh.h"

namespace furrow::character {

// How a shape changes a material: a blush, a face that darkens, irises that slide over the eye.
// What several shapes change adds up: value = value of the material + sum of weight * change.
struct MaterialBind {
  std::uint32_t shape = 0;     // index into Character::shapes
  std::uint32_t material = 0;  // index into Character::materials
  glm::vec4 base_colour{0.0f};
  glm::vec3 emission{0.0f};
  // Of uv * (1 + scale) + offset, where uv are the UVs of the material's textures at rest.
  glm::vec2 uv_scale{0.0f};
  glm::vec2 uv_offset{0.0f};

  [[nodiscard]] bool moves_uvs() const {
    return uv_scale != glm::vec2(0.0f) || uv_offset != glm::vec2(0.0f);
  }
};

// The part of a material that binds change.
struct MaterialLook {
  glm::vec4 base_colour{1.0f};  // see Material
  glm::vec3 emission{0.0f};
  glm::vec2 texture_scale{1.0f};
  glm::vec2 texture_offset{0.0f};

  friend bool operator==(const MaterialLook&, const MaterialLook&) = default;
};

// The look of `material` in a pose. `binds`: those of the material. `shapes`: the weights of the
// character's shapes, or empty: all 0. As VRM requires, a weight counts as its nearest number in
// [0, 1]. Colours stay in [0, 1], emissions in [0, gltf::kMaxEmission].
[[nodiscard]] MaterialLook LookOf(const Material& material, std::span<const MaterialBind> binds,
                                  std::span<const float> shapes);

}  // namespace furrow::character
