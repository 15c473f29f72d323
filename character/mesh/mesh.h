// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "character/mesh/morph_target.h"

namespace furrow::character {

// The parts of glTF's metallic-roughness material that are drawn, and the kind of surface.
struct Material {
  // kShade: a shell that only darkens what lies behind it, such as the shadow of the lids on the
  // eyeball. Its base colour is the share of light that passes, as if multiplied.
  enum class Kind { kSkin, kCloth, kEye, kHair, kOther, kShade };
  std::string name;
  Kind kind = Kind::kOther;
  // False: the rig's wrinkle maps are not drawn on this material, because its UVs overlap those of
  // the material that they were baked for, or because it has none.
  bool wrinkles = true;
  glm::vec4 base_colour{1.0f};  // linear RGBA in [0, 1]; multiplies the texture
  // Textures are indices into Character::pictures; -1: none.
  int base_colour_texture = -1;  // sRGB
  int normal_texture = -1;       // tangent space; green points up in the image (glTF)
  float roughness = 0.6f;        // [0, 1]: 0 mirror-like, 1 matte; multiplies the texture
  int roughness_texture = -1;    // green channel
  // Light that the surface sends out itself, linear, in units of white paper in the lamps' light.
  // Multiplies the texture.
  glm::vec3 emission{0.0f};
  int emission_texture = -1;  // sRGB
  // Thickness of translucent flesh in metres (KHR_materials_volume); 0 if the file does not state
  // it. Multiplies the green channel of thickness_texture, if there is one.
  float thickness = 0.0f;
  int thickness_texture = -1;
  // UVs of the mesh to UVs of the textures above: uv * scale + offset. Not the identity if
  // materials with overlapping UVs share one atlas of wrinkle maps, each in its own tile.
  glm::vec2 texture_scale{1.0f};
  glm::vec2 texture_offset{0.0f};
  bool double_sided = false;
  float alpha_cutoff = 0.0f;  // texels with less alpha are not drawn; 0 for opaque materials
};

// Positions and directions are in model space, in the rest pose.
struct Vertex {
  glm::vec3 position{0.0f};                   // metres
  glm::vec3 normal{0.0f, 0.0f, 1.0f};         // unit
  glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};  // xyz: unit; w: 1 or -1, the bitangent's sign (glTF)
  glm::vec2 uv{0.0f};                         // (0, 0): top left of the texture image (glTF)
  std::uint16_t joints[4] = {0, 0, 0, 0};     // indices into Character::skeleton
  float skin_weights[4] = {1.0f, 0.0f, 0.0f, 0.0f};  // sum to 1
};

// One primitive of a glTF mesh: triangles of one material.
struct Mesh {
  std::string name;
  int material = -1;  // index into Character::materials; -1: none
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from outside
  std::vector<MorphTarget> morph_targets;  // ascending by shape, at most one per shape
};

}  // namespace furrow::character
