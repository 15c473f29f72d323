// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"

namespace furrow::gltf {

// The extra in which Furrow keeps the kind of a material ("skin", "cloth", ...).
inline constexpr char kKindExtra[] = "furrow_kind";
// The extra, false, that keeps wrinkle maps off a material.
inline constexpr char kWrinklesExtra[] = "furrow_wrinkles";

// The extra, true, of a material whose meshes lie in a tile of a shared atlas. The meshes keep
// these UVs for wrinkle maps and masks, and KHR_texture_transform leads to the material's own
// textures.
inline constexpr char kAtlasTileExtra[] = "furrow_atlas_tile";

// The strongest light that a material may state, in units of white paper in the sun.
inline constexpr float kMaxEmission = 100.0f;

// KHR_texture_transform: how UVs of the mesh become UVs of the image.
struct UvTransform {
  glm::vec2 offset{0.0f};
  float rotation = 0.0f;  // radians, counter-clockwise as seen in the image, about (0, 0)
  glm::vec2 scale{1.0f};

  bool operator==(const UvTransform&) const = default;
  [[nodiscard]] glm::vec2 Apply(const glm::vec2& uv) const;
};

// A metallic-roughness material. Texture fields are indices into Document::images(), or kNone.
struct Material {
  std::string name;
  std::string kind;             // kKindExtra; may be empty
  bool wrinkles = true;         // kWrinklesExtra
  glm::vec4 base_colour{1.0f};  // linear, clamped to [0, 1]
  int base_colour_image = kNone;
  int normal_image = kNone;
  float roughness = 1.0f;       // clamped to [0, 1]
  int roughness_image = kNone;  // green channel
  // Light of its own, linear, in [0, kMaxEmission]: emissiveFactor times
  // KHR_materials_emissive_strength. Multiplies the texture.
  glm::vec3 emission{0.0f};
  int emission_image = kNone;  // sRGB
  // The colour of MToon where no light arrives, linear; nullopt for other materials.
  std::optional<glm::vec3> shade_colour;
  float thickness = 0.0f;       // metres (KHR_materials_volume); 0: not stated
  int thickness_image = kNone;  // green channel, times `thickness`
  bool double_sided = false;
  // Of all textures. If they differ, that of the base colour and a warning.
  UvTransform uv_transform;
  int uv_set = 0;              // of all textures: n of TEXCOORD_n
  bool is_atlas_tile = false;  // kAtlasTileExtra
  float alpha_cutoff = 0.0f;   // 0: opaque. alphaMode BLEND becomes 0.5.
};

// All materials of a document with Contents::kCharacter. A material without a base colour texture
// takes MToon's lit texture (`_MainTex`) and, where glTF states no colour, its lit colour
// (`_Color`, sRGB; both VRM 0.x), or the diffuse texture, colour and glossiness of
// KHR_materials_pbrSpecularGlossiness. Textures with another set of UVs than the first texture of
// their material are left out, with a warning.
//
// Errors: kLimit (kMaxMaterials), kSchema (a texture or image that does not exist), kNonFinite.
[[nodiscard]] Result<std::vector<Material>> ReadMaterials(Document* document);

// An image in its file format (PNG, JPEG, ...).
struct EncodedImage {
  std::filesystem::path file;          // an external file, not opened yet; else empty
  std::span<const std::uint8_t> view;  // of a buffer view
  std::vector<std::uint8_t> decoded;   // of a data URI

  // The image if `file` is empty.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const {
    return decoded.empty() ? view : std::span<const std::uint8_t>(decoded);
  }
};

// Locates image `index` of Document::images(). The document must outlive the result. Errors:
// DecodeDataUri()'s, FindExternalFile()'s.
[[nodiscard]] Result<EncodedImage> LocateImage(const Document& document, std::size_t index);

}  // namespace furrow::gltf
