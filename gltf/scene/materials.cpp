// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/materials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <tiny_gltf.h>

#include "base/srgb.h"
#include "gltf/container/uri.h"
#include "gltf/document/json_value.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

constexpr int kMaxUvSets = 8;

// Only what the renderer draws: metalness and occlusion are ignored.
class MaterialReader {
 public:
  // `vrm`: the material's properties in VRM 0.x; null if the file has none.
  MaterialReader(Document* document, const tinygltf::Material& from, const tinygltf::Value* vrm,
                 std::string field)
      : document_(*document), from_(from), vrm_(vrm), field_(std::move(field)) {}

  Result<Material> Run() {
    const std::string in_pbr = ".pbrMetallicRoughness.";
    const tinygltf::PbrMetallicRoughness& pbr = from_.pbrMetallicRoughness;
    Material to;
    to.name = from_.name;
    if (from_.extras.IsObject() && from_.extras.Get(kKindExtra).IsString()) {
      to.kind = from_.extras.Get(kKindExtra).Get<std::string>();
    }
    if (from_.extras.IsObject() && from_.extras.Get(kWrinklesExtra).IsBool()) {
      to.wrinkles = from_.extras.Get(kWrinklesExtra).Get<bool>();
    }
    if (from_.extras.IsObject() && from_.extras.Get(kAtlasTileExtra).IsBool()) {
      to.is_atlas_tile = from_.extras.Get(kAtlasTileExtra).Get<bool>();
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(pbr.baseColorFactor.size(), 4); ++i) {
      const auto factor = static_cast<float>(pbr.baseColorFactor[i]);
      if (!std::isfinite(factor)) {
        return Status(StatusCode::kNonFinite, "the colour is not finite",
                      field_ + ".baseColorFactor");
      }
      to.base_colour[static_cast<int>(i)] = std::clamp(factor, 0.0f, 1.0f);
    }
    // std::clamp leaves a NaN as it is; JSON cannot express one.
    to.roughness = std::clamp(static_cast<float>(pbr.roughnessFactor), 0.0f, 1.0f);
    to.double_sided = from_.doubleSided;
    // Blended surfaces would have to be sorted; a cut-out comes near enough.
    if (from_.alphaMode == "BLEND") to.alpha_cutoff = 0.5f;
    if (from_.alphaMode == "MASK") {
      to.alpha_cutoff = std::clamp(static_cast<float>(from_.alphaCutoff), 0.0f, 1.0f);
    }
    FURROW_RETURN_IF_ERROR(
        ReadTexture(pbr.baseColorTexture, in_pbr + "baseColorTexture", &to.base_colour_image));
    if (to.base_colour_image == kNone) {
      ReadMToonColour(&to);
      FURROW_RETURN_IF_ERROR(ReadMToonTexture(&to));
    }
    if (to.base_colour_image == kNone) FURROW_RETURN_IF_ERROR(ReadSpecularGlossiness(&to));
    FURROW_RETURN_IF_ERROR(ReadTexture(pbr.metallicRoughnessTexture,
                                       in_pbr + "metallicRoughnessTexture", &to.roughness_image));
    FURROW_RETURN_IF_ERROR(ReadTexture(from_.normalTexture, ".normalTexture", &to.normal_image));
    FURROW_RETURN_IF_ERROR(ReadEmission(&to));
    FURROW_RETURN_IF_ERROR(ReadThickness(&to));
    to.shade_colour = ShadeColour();
    to.uv_transform = uv_transform_.value_or(UvTransform());
    to.uv_set = std::max(uv_set_, 0);
    if (transforms_differ_) {
      document_.Warn(field_,
                     "its textures have different KHR_texture_transform; the first is used "
                     "for all");
    }
    return to;
  }

 private:
  // The lit colour of MToon, in files whose glTF material states none of its own. VRM 0.x keeps
  // Unity's value, which is sRGB.
  void ReadMToonColour(Material* to) const {
    if (vrm_ == nullptr || !vrm_->IsObject() || to->base_colour != glm::vec4(1.0f)) return;
    const tinygltf::Value& vectors = vrm_->Get("vectorProperties");
    if (!vectors.IsObject() || !vectors.Get("_Color").IsArray()) return;
    const tinygltf::Value& colour = vectors.Get("_Color");
    for (int i = 0; i < std::min(static_cast<int>(colour.ArrayLen()), 4); ++i) {
      if (!colour.Get(i).IsNumber()) continue;
      // std::clamp leaves a NaN as it is; JSON cannot express one.
      const auto stated = static_cast<float>(colour.Get(i).GetNumberAsDouble());
      const float limited = std::clamp(stated, 0.0f, 1.0f);
      to->base_colour[i] = i == 3 ? limited : LinearFromSrgb(limited);
    }
  }

  // The light that the surface sends out itself.
  Status ReadEmission(Material* to) {
    const auto strength = from_.extensions.find("KHR_materials_emissive_strength");
    double factor = 1.0;
    if (strength != from_.extensions.end()) {
      const tinygltf::Value& stated = Member(strength->second, "emissiveStrength");
      if (stated.IsNumber()) factor = stated.GetNumberAsDouble();
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(from_.emissiveFactor.size(), 3); ++i) {
      const auto light = static_cast<float>(factor * from_.emissiveFactor[i]);
      if (!std::isfinite(light)) {
        return {StatusCode::kNonFinite, "the emission is not finite", field_ + ".emissiveFactor"};
      }
      to->emission[static_cast<int>(i)] = std::clamp(light, 0.0f, kMaxEmission);
    }
    return ReadTexture(from_.emissiveTexture, ".emissiveTexture", &to->emission_image);
  }

  // Of MToon in VRM 1.0 and 0.x.
  [[nodiscard]] std::optional<glm::vec3> ShadeColour() const {
    const auto mtoon = from_.extensions.find("VRMC_materials_mtoon");
    const bool is_vrm1 = mtoon != from_.extensions.end();
    if (!is_vrm1 && vrm_ == nullptr) return std::nullopt;
    const tinygltf::Value& stated = is_vrm1
                                        ? Member(mtoon->second, "shadeColorFactor")
                                        : Member(Member(*vrm_, "vectorProperties"), "_ShadeColor");
    if (!stated.IsArray() || stated.ArrayLen() < 3) {
      return is_vrm1 ? std::optional(glm::vec3(0.0f)) : std::nullopt;
    }
    glm::vec3 colour(0.0f);
    for (int i = 0; i < 3; ++i) {
      if (!stated.Get(i).IsNumber()) return std::nullopt;
      colour[i] = std::clamp(static_cast<float>(stated.Get(i).GetNumberAsDouble()), 0.0f, 1.0f);
      if (!is_vrm1) colour[i] = LinearFromSrgb(colour[i]);
    }
    return colour;
  }

  // The lit texture of MToon, in files whose glTF material states no texture of its own. VRM 1.0
  // has none of its own: it always uses glTF's.
  Status ReadMToonTexture(Material* to) {
    if (vrm_ == nullptr || !vrm_->IsObject()) return {};
    const tinygltf::Value& textures = vrm_->Get("textureProperties");
    if (!textures.IsObject() || !textures.Get("_MainTex").IsInt()) return {};
    UvTransform transform;
    const tinygltf::Value& vectors = vrm_->Get("vectorProperties");
    if (vectors.IsObject() && vectors.Get("_MainTex").IsArray()) {
      const auto number = [&](int i) {
        const tinygltf::Value& value = vectors.Get("_MainTex").Get(i);
        return value.IsNumber() ? static_cast<float>(value.GetNumberAsDouble()) : 0.0f;
      };
      if (vectors.Get("_MainTex").ArrayLen() == 4) {
        // Unity's v points up, glTF's down.
        transform = {.offset = {number(0), 1.0f - number(1) - number(3)},
                     .scale = {number(2), number(3)}};
      }
      for (const float value :
           {transform.offset.x, transform.offset.y, transform.scale.x, transform.scale.y}) {
        if (!std::isfinite(value)) {
          return {StatusCode::kNonFinite, "the texture transform is not finite", VrmField()};
        }
      }
    }
    if (UseUvSet(0, "._MainTex")) UseTransform(transform);
    return FindImage(textures.Get("_MainTex").Get<int>(), VrmField(), &to->base_colour_image);
  }

  // The older workflow of a shiny, coloured surface. Its diffuse colour is the base colour of
  // things that are not metal, and files that state it often state nothing else.
  Status ReadSpecularGlossiness(Material* to) {
    const auto found = from_.extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (found == from_.extensions.end() || !found->second.IsObject()) return {};
    const std::string member = ".extensions.KHR_materials_pbrSpecularGlossiness";
    const tinygltf::Value& factor = found->second.Get("diffuseFactor");
    for (int i = 0; factor.IsArray() && i < 4; ++i) {
      const tinygltf::Value& value = factor.Get(i);
      const auto number = value.IsNumber() ? static_cast<float>(value.GetNumberAsDouble()) : 1.0f;
      if (!std::isfinite(number)) {
        return {StatusCode::kNonFinite, "the colour is not finite",
                field_ + member + ".diffuseFactor"};
      }
      to->base_colour[i] = std::clamp(number, 0.0f, 1.0f);
    }
    const tinygltf::Value& glossiness = found->second.Get("glossinessFactor");
    if (glossiness.IsNumber()) {
      to->roughness =
          1.0f - std::clamp(static_cast<float>(glossiness.GetNumberAsDouble()), 0.0f, 1.0f);
    }
    const tinygltf::Value& texture = found->second.Get("diffuseTexture");
    if (!texture.IsObject() || !texture.Get("index").IsInt()) return {};
    return ReadTexture(ReferenceFrom(texture), member + ".diffuseTexture", &to->base_colour_image);
  }

  // A texture reference inside of an extension, which tinygltf does not parse.
  static tinygltf::TextureInfo ReferenceFrom(const tinygltf::Value& from) {
    tinygltf::TextureInfo info;
    info.index = from.Get("index").Get<int>();
    if (from.Get("texCoord").IsInt()) info.texCoord = from.Get("texCoord").Get<int>();
    const tinygltf::Value& extensions = from.Get("extensions");
    if (extensions.IsObject() && extensions.Has("KHR_texture_transform")) {
      info.extensions["KHR_texture_transform"] = extensions.Get("KHR_texture_transform");
    }
    return info;
  }

  // `info`: tinygltf's type of a texture reference, of which there are two.
  template <class Info>
  Status ReadTexture(const Info& info, const std::string& member, int* image) {
    if (info.index < 0) return {};
    int tex_coord = info.texCoord;
    const auto extension = info.extensions.find("KHR_texture_transform");
    UvTransform transform;
    if (extension != info.extensions.end()) {
      FURROW_RETURN_IF_ERROR(ReadUvTransform(extension->second, member, &transform, &tex_coord));
    }
    if (!UseUvSet(tex_coord, member)) return {};
    UseTransform(transform);
    return FindImage(info.index, member, image);
  }

  // Meshes are drawn with one set of UVs per material, that of its first texture. False for a
  // texture with another set.
  bool UseUvSet(int tex_coord, const std::string& member) {
    if (uv_set_ < 0) uv_set_ = std::clamp(tex_coord, 0, kMaxUvSets - 1);
    if (tex_coord == uv_set_) return true;
    document_.Warn(field_ + member + ".texCoord",
                   "the texture uses TEXCOORD_" + std::to_string(tex_coord) +
                       ", the material's first texture TEXCOORD_" + std::to_string(uv_set_) +
                       "; it is left out (give all textures of a material the same set of UVs)");
    return false;
  }

  // The material is drawn with one set of UVs, and so with one transform.
  void UseTransform(const UvTransform& transform) {
    transforms_differ_ = transforms_differ_ || (uv_transform_ && *uv_transform_ != transform);
    if (!uv_transform_) uv_transform_ = transform;
  }

  Status ReadUvTransform(const tinygltf::Value& from, const std::string& member, UvTransform* to,
                         int* tex_coord) const {
    const std::string field = field_ + member + ".extensions.KHR_texture_transform";
    if (!from.IsObject()) return {StatusCode::kSchema, "expected an object", field};
    const auto number = [](const tinygltf::Value& value, float* into) {
      if (value.IsNumber()) *into = static_cast<float>(value.GetNumberAsDouble());
    };
    for (int i = 0; i < 2; ++i) {
      if (from.Get("offset").IsArray()) number(from.Get("offset").Get(i), &to->offset[i]);
      if (from.Get("scale").IsArray()) number(from.Get("scale").Get(i), &to->scale[i]);
    }
    number(from.Get("rotation"), &to->rotation);
    if (from.Get("texCoord").IsInt()) *tex_coord = from.Get("texCoord").Get<int>();
    for (const float value : {to->offset.x, to->offset.y, to->scale.x, to->scale.y, to->rotation}) {
      if (std::isfinite(value)) continue;
      return {StatusCode::kNonFinite, "the texture transform is not finite", field};
    }
    return {};
  }

  Status FindImage(int texture, const std::string& member, int* image) const {
    const tinygltf::Model& model = document_.model();
    *image = kNone;
    if (texture < 0) return {};
    if (texture >= static_cast<int>(model.textures.size())) {
      return {StatusCode::kSchema, "texture " + std::to_string(texture) + " does not exist",
              field_ + member + ".index"};
    }
    const int source = model.textures[static_cast<std::size_t>(texture)].source;
    // -1 is a texture whose image only an extension states.
    if (source < kNone || source >= static_cast<int>(document_.images().size())) {
      return {StatusCode::kSchema, "image " + std::to_string(source) + " does not exist",
              "textures[" + std::to_string(texture) + "].source"};
    }
    *image = source;
    return {};
  }

  // The part of KHR_materials_volume that says how thick a thing is.
  Status ReadThickness(Material* to) {
    const auto volume = from_.extensions.find("KHR_materials_volume");
    if (volume == from_.extensions.end() || !volume->second.IsObject()) return {};
    const std::string member = ".extensions.KHR_materials_volume";
    const tinygltf::Value& factor = volume->second.Get("thicknessFactor");
    if (factor.IsNumber()) {
      to->thickness = static_cast<float>(factor.GetNumberAsDouble());
      if (!std::isfinite(to->thickness) || to->thickness < 0.0f) {
        return {StatusCode::kNonFinite, "the thickness must be finite and not negative",
                field_ + member + ".thicknessFactor"};
      }
    }
    const tinygltf::Value& texture = volume->second.Get("thicknessTexture");
    if (!texture.IsObject() || !texture.Get("index").IsInt()) return {};
    const tinygltf::Value& coord = texture.Get("texCoord");
    const std::string thickness = member + ".thicknessTexture";
    if (!UseUvSet(coord.IsInt() ? coord.Get<int>() : 0, thickness)) return {};
    return FindImage(texture.Get("index").Get<int>(), thickness, &to->thickness_image);
  }

  static std::string VrmField() { return " (extensions.VRM.materialProperties: _MainTex)"; }

  Document& document_;
  const tinygltf::Material& from_;
  const tinygltf::Value* vrm_;
  const std::string field_;
  std::optional<UvTransform> uv_transform_;  // of the first texture
  int uv_set_ = -1;                          // of the first texture; -1: none yet
  bool transforms_differ_ = false;
};

// The list of VRM 0.x, in the order of the materials; null if the file has none.
const tinygltf::Value* VrmMaterials(const tinygltf::Model& model) {
  const auto found = model.extensions.find("VRM");
  if (found == model.extensions.end() || !found->second.IsObject()) return nullptr;
  const tinygltf::Value& list = found->second.Get("materialProperties");
  return list.IsArray() ? &list : nullptr;
}

}  // namespace

glm::vec2 UvTransform::Apply(const glm::vec2& uv) const {
  const glm::vec2 scaled = scale * uv;
  const float c = std::cos(rotation), s = std::sin(rotation);
  // v points down, so a counter-clockwise turn has this sign.
  return offset + glm::vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
}

Result<std::vector<Material>> ReadMaterials(Document* document) {
  const std::vector<tinygltf::Material>& from = document->model().materials;
  if (from.size() > kMaxMaterials) {
    return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxMaterials) + " materials",
                  "materials");
  }
  const tinygltf::Value* const vrm = VrmMaterials(document->model());
  std::vector<Material> materials;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const tinygltf::Value* const of_vrm =
        vrm != nullptr && i < vrm->ArrayLen() ? &vrm->Get(static_cast<int>(i)) : nullptr;
    Result<Material> material =
        MaterialReader(document, from[i], of_vrm, "materials[" + std::to_string(i) + "]").Run();
    FURROW_RETURN_IF_ERROR(material);
    materials.push_back(std::move(*material));
  }
  return materials;
}

Result<EncodedImage> LocateImage(const Document& document, std::size_t index) {
  const ImageSource& image = document.images()[index];
  EncodedImage encoded;
  if (image.view != kNone) {
    encoded.view = document.views()[static_cast<std::size_t>(image.view)].bytes;
    return encoded;
  }
  if (IsDataUri(image.uri)) {
    Result<std::vector<std::uint8_t>> bytes = DecodeDataUri(image.uri);
    FURROW_RETURN_IF_ERROR(bytes);
    encoded.decoded = std::move(*bytes);
    return encoded;
  }
  Result<std::filesystem::path> file = FindExternalFile(image.uri, document.options().folder);
  FURROW_RETURN_IF_ERROR(file);
  encoded.file = std::move(*file);
  return encoded;
}

}  // namespace furrow::gltf
