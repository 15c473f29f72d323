// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/materials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tiny_gltf.h>

#include "gltf/container/uri.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

// Only what the renderer draws: metalness, emission and occlusion are ignored.
class MaterialReader {
 public:
  MaterialReader(const Document& document, const tinygltf::Material& from, std::string field)
      : document_(document), from_(from), field_(std::move(field)) {}

  Result<Material> Run() {
    const tinygltf::PbrMetallicRoughness& pbr = from_.pbrMetallicRoughness;
    Material to;
    to.name = from_.name;
    if (from_.extras.IsObject() && from_.extras.Get(kKindExtra).IsString()) {
      to.kind = from_.extras.Get(kKindExtra).Get<std::string>();
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
    FURROW_RETURN_IF_ERROR(ReadTexture(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord,
                                       ".pbrMetallicRoughness.baseColorTexture",
                                       &to.base_colour_image));
    FURROW_RETURN_IF_ERROR(
        ReadTexture(pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord,
                    ".pbrMetallicRoughness.metallicRoughnessTexture", &to.roughness_image));
    FURROW_RETURN_IF_ERROR(ReadTexture(from_.normalTexture.index, from_.normalTexture.texCoord,
                                       ".normalTexture", &to.normal_image));
    FURROW_RETURN_IF_ERROR(ReadThickness(&to));
    return to;
  }

 private:
  Status ReadTexture(int texture, int tex_coord, const std::string& member, int* image) const {
    const tinygltf::Model& model = document_.model();
    *image = kNone;
    if (texture < 0) return {};
    if (texture >= static_cast<int>(model.textures.size())) {
      return {StatusCode::kSchema, "texture " + std::to_string(texture) + " does not exist",
              field_ + member + ".index"};
    }
    if (tex_coord != 0) {
      return {StatusCode::kUnsupported, "only TEXCOORD_0 is supported",
              field_ + member + ".texCoord"};
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
  Status ReadThickness(Material* to) const {
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
    return ReadTexture(texture.Get("index").Get<int>(), coord.IsInt() ? coord.Get<int>() : 0,
                       member + ".thicknessTexture", &to->thickness_image);
  }

  const Document& document_;
  const tinygltf::Material& from_;
  const std::string field_;
};

}  // namespace

Result<std::vector<Material>> ReadMaterials(const Document& document) {
  const std::vector<tinygltf::Material>& from = document.model().materials;
  if (from.size() > kMaxMaterials) {
    return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxMaterials) + " materials",
                  "materials");
  }
  std::vector<Material> materials;
  for (std::size_t i = 0; i < from.size(); ++i) {
    Result<Material> material =
        MaterialReader(document, from[i], "materials[" + std::to_string(i) + "]").Run();
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
