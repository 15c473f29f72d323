// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/material_bind.h"

#include <algorithm>

#include <glm/common.hpp>

#include "gltf/scene/materials.h"

namespace furrow::character {

MaterialLook LookOf(const Material& material, std::span<const MaterialBind> binds,
                    std::span<const float> shapes) {
  MaterialLook look{material.base_colour, material.emission, material.texture_scale,
                    material.texture_offset};
  glm::vec2 scale(1.0f);
  glm::vec2 offset(0.0f);
  bool is_changed = false;
  for (const MaterialBind& bind : binds) {
    if (bind.shape >= shapes.size()) continue;
    // Written so that a NaN counts as 0.
    const float weight = shapes[bind.shape] > 0.0f ? std::min(shapes[bind.shape], 1.0f) : 0.0f;
    if (weight == 0.0f) continue;
    is_changed = true;
    look.base_colour += weight * bind.base_colour;
    look.emission += weight * bind.emission;
    scale += weight * bind.uv_scale;
    offset += weight * bind.uv_offset;
  }
  if (!is_changed) return look;
  look.base_colour = glm::clamp(look.base_colour, 0.0f, 1.0f);
  look.emission = glm::clamp(look.emission, 0.0f, gltf::kMaxEmission);
  look.texture_scale *= scale;
  look.texture_offset = look.texture_offset * scale + offset;
  return look;
}

}  // namespace furrow::character
