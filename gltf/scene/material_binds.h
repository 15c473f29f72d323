// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/materials.h"

namespace furrow::gltf {

// `extras` of a package's first scene: an array of binds, as an object each with the members
// "shape" (a name), "material" (an index), and what changes at a weight of 1: "baseColor" (4
// numbers), "emission" (3), "uvScale" and "uvOffset" (2). Missing ones are 0.
inline constexpr char kMaterialBindsExtra[] = "furrow_material_binds";

// How an expression changes a material. Several binds of a material add up:
//
//   value = value of the material + sum of weight * change
//
// (VRMC_vrm-1.0, "Expression update algorithm": base + (target - base) * weight.)
struct MaterialBind {
  std::string shape;            // the name of the expression; not empty
  int material = 0;             // checked: in range
  glm::vec4 base_colour{0.0f};  // linear
  glm::vec3 emission{0.0f};     // linear
  // Of uv * (1 + scale) + offset, where uv are those of the textures at rest: after the material's
  // own transform.
  glm::vec2 uv_scale{0.0f};
  glm::vec2 uv_offset{0.0f};

  [[nodiscard]] bool does_nothing() const;
};

// Reads the binds of materials of VRM 1.0 (materialColorBinds, textureTransformBinds) and 0.x
// (materialValues), or of kMaterialBindsExtra. `materials`: those of the document. At most one
// bind per expression and material; those that change nothing are left out.
//
// - Colours and emission are those that glTF's materials have. VRM 0.x states them as Unity does:
//   sRGB, except for the emission.
// - The renderer has no colour of its own for shade, as MToon has. An expression that changes only
//   the colour of the shade moves the base colour by half as much, because half of a lit ball is
//   in shade. Where an expression changes both, the base colour's change counts.
// - Textures of a material share one transform. VRM 0.x states it per texture: `_MainTex` counts,
//   and others that an expression states beside it are taken to be the same.
//
// Deviations give a warning each, and are ignored: properties that are not drawn (rim, outline and
// matcap colours), by name; materials that do not exist; values that are not finite or beyond
// kMaxUvChange; scales of a material that turns its textures, or that shows them without extent.
//
// Error: kLimit (more than kMaxVrmBinds binds).
[[nodiscard]] Result<std::vector<MaterialBind>> ReadMaterialBinds(
    Document* document, std::span<const Material> materials);

// The largest scale or offset of UVs.
inline constexpr float kMaxUvChange = 1e4f;

}  // namespace furrow::gltf
