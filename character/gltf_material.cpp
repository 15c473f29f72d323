// SPDX-License-Identifier: Apache-2.0
#include "character/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <tiny_gltf.h>

#include "base/asset_path.h"
#include "base/status.h"
#include "character/picture_file.h"

namespace furrow::character {
namespace {

using Kind = Material::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 5> kKindNames = {{{"skin", Kind::kSkin},
                                                                          {"cloth", Kind::kCloth},
                                                                          {"eye", Kind::kEye},
                                                                          {"hair", Kind::kHair},
                                                                          {"other", Kind::kOther}}};

// In this order: "eyebrow" and "eyelash" are hair, not eyes.
constexpr std::array<std::pair<std::string_view, Kind>, 22> kHints = {
    {{"lash", Kind::kHair},   {"brow", Kind::kHair},    {"hair", Kind::kHair},
     {"beard", Kind::kHair},  {"eye", Kind::kEye},      {"cornea", Kind::kEye},
     {"iris", Kind::kEye},    {"cloth", Kind::kCloth},  {"suit", Kind::kCloth},
     {"shirt", Kind::kCloth}, {"jeans", Kind::kCloth},  {"trouser", Kind::kCloth},
     {"pants", Kind::kCloth}, {"jacket", Kind::kCloth}, {"sweater", Kind::kCloth},
     {"dress", Kind::kCloth}, {"fabric", Kind::kCloth}, {"sleeve", Kind::kCloth},
     {"skin", Kind::kSkin},   {"face", Kind::kSkin},    {"head", Kind::kSkin},
     {"body", Kind::kSkin}}};

Result<Picture> ReadPicture(const tinygltf::Model& model, const tinygltf::Image& image,
                            const std::string& name, const std::filesystem::path& folder) {
  if (image.bufferView >= 0) {
    const tinygltf::BufferView& view = model.bufferViews[image.bufferView];
    const auto& bytes = model.buffers[view.buffer].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
      return Status(StatusCode::kParse, "the picture ends past its buffer");
    }
    return DecodePicture(name, std::span(bytes).subspan(view.byteOffset, view.byteLength));
  }
  if (!image.image.empty()) return DecodePicture(name, image.image);
  const Result<std::filesystem::path> path = FindAsset(image.uri, folder);
  FURROW_RETURN_IF_ERROR(path);
  return LoadPicture(name, *path);
}

// A texture's picture: -1 for none, an error for an index that leads nowhere.
Status PictureOf(const tinygltf::Model& model, int texture, int tex_coord, const std::string& where,
                 int* picture) {
  *picture = -1;
  if (texture < 0) return {};
  if (texture >= static_cast<int>(model.textures.size())) {
    return {StatusCode::kSchema, "there is no texture " + std::to_string(texture),
            where + ".index"};
  }
  if (tex_coord != 0) {
    return {StatusCode::kUnsupported, "only TEXCOORD_0 is read", where + ".texCoord"};
  }
  const int source = model.textures[texture].source;
  if (source >= static_cast<int>(model.images.size())) {
    return {StatusCode::kSchema, "there is no image " + std::to_string(source),
            "textures[" + std::to_string(texture) + "].source"};
  }
  *picture = source;
  return {};
}

Kind KindOf(const tinygltf::Material& material) {
  if (material.extras.IsObject() && material.extras.Has("furrow_kind")) {
    const tinygltf::Value& value = material.extras.Get("furrow_kind");
    for (const auto& [name, kind] : kKindNames) {
      if (value.IsString() && value.Get<std::string>() == name) return kind;
    }
  }
  return GuessMaterialKind(material.name);
}

// KHR_materials_volume, as far as it says how thick a thing is.
Status ReadThickness(const tinygltf::Model& model, const tinygltf::Material& from,
                     const std::string& at, Material* to) {
  const auto volume = from.extensions.find("KHR_materials_volume");
  if (volume == from.extensions.end() || !volume->second.IsObject()) return {};
  const std::string where = at + ".extensions.KHR_materials_volume";
  const tinygltf::Value& factor = volume->second.Get("thicknessFactor");
  if (factor.IsNumber()) {
    const double thickness = factor.GetNumberAsDouble();
    if (!std::isfinite(thickness) || thickness < 0.0) {
      return {StatusCode::kNonFinite, "the thickness must be finite and not negative",
              where + ".thicknessFactor"};
    }
    to->thickness = static_cast<float>(thickness);
  }
  const tinygltf::Value& texture = volume->second.Get("thicknessTexture");
  if (!texture.IsObject() || !texture.Get("index").IsInt()) return {};
  const tinygltf::Value& coord = texture.Get("texCoord");
  return PictureOf(model, texture.Get("index").Get<int>(), coord.IsInt() ? coord.Get<int>() : 0,
                   where + ".thicknessTexture", &to->thickness_texture);
}

Status ReadMaterial(const tinygltf::Model& model, const tinygltf::Material& from,
                    const std::string& at, Material* to) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  to->name = from.name;
  to->kind = KindOf(from);
  for (std::size_t i = 0; i < pbr.baseColorFactor.size() && i < 4; ++i) {
    const auto factor = static_cast<float>(pbr.baseColorFactor[i]);
    if (!std::isfinite(factor)) {
      return {StatusCode::kNonFinite, "the colour is not finite", at + ".baseColorFactor"};
    }
    to->base_colour[static_cast<int>(i)] = std::clamp(factor, 0.0f, 1.0f);
  }
  to->roughness = std::clamp(static_cast<float>(pbr.roughnessFactor), 0.0f, 1.0f);
  to->double_sided = from.doubleSided;
  // Blending needs an order of drawing; what is half transparent is cut out instead.
  if (from.alphaMode == "BLEND") to->alpha_cutoff = 0.5f;
  if (from.alphaMode == "MASK") {
    to->alpha_cutoff = std::clamp(static_cast<float>(from.alphaCutoff), 0.0f, 1.0f);
  }
  const tinygltf::TextureInfo& colour = pbr.baseColorTexture;
  const tinygltf::TextureInfo& rough = pbr.metallicRoughnessTexture;
  if (Status s = PictureOf(model, colour.index, colour.texCoord,
                           at + ".pbrMetallicRoughness.baseColorTexture", &to->base_colour_texture);
      !s.ok()) {
    return s;
  }
  if (Status s =
          PictureOf(model, rough.index, rough.texCoord,
                    at + ".pbrMetallicRoughness.metallicRoughnessTexture", &to->roughness_texture);
      !s.ok()) {
    return s;
  }
  if (Status s = PictureOf(model, from.normalTexture.index, from.normalTexture.texCoord,
                           at + ".normalTexture", &to->normal_texture);
      !s.ok()) {
    return s;
  }
  return ReadThickness(model, from, at, to);
}

}  // namespace

Kind GuessMaterialKind(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const auto& [hint, kind] : kHints) {
    if (lower.find(hint) != std::string::npos) return kind;
  }
  return Kind::kOther;
}

std::string_view MaterialKindName(Kind kind) {
  return kKindNames[static_cast<std::size_t>(kind)].first;
}

Result<std::vector<Picture>> ReadGltfPictures(const tinygltf::Model& model,
                                              const std::filesystem::path& folder,
                                              const ReadOptions& options) {
  if (model.images.size() > kMaxPictures) {
    return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxPictures) + " pictures",
                  "images");
  }
  std::vector<Picture> pictures;
  std::int64_t pixels = 0;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const tinygltf::Image& image = model.images[i];
    const std::string where = "images[" + std::to_string(i) + "]";
    const std::string name = image.name.empty() ? image.uri : image.name;
    Result<Picture> picture = ReadPicture(model, image, name, folder);
    if (!picture.ok() && options.lenient && picture.status().code() != StatusCode::kLimit) {
      if (options.notes != nullptr) {
        options.notes->missing_pictures.push_back(name + ": " + picture.status().what());
      }
      pictures.push_back({.name = name, .pixels = {}, .pixels16 = {}});
      continue;
    }
    if (!picture.ok()) {
      const Status s = picture.status();
      return Status(s.code(), s.where().empty() ? s.what() : s.where() + ": " + s.what(), where,
                    s.todo());
    }
    pixels += static_cast<std::int64_t>(picture->width) * picture->height;
    if (pixels > 4 * kMaxPicturePixels) {
      return Status(StatusCode::kLimit, "the pictures have too many pixels in all", where);
    }
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

Result<std::vector<Material>> ReadGltfMaterials(const tinygltf::Model& model) {
  if (model.materials.size() > kMaxMaterials) {
    return Status(StatusCode::kLimit, "too many materials", "materials");
  }
  std::vector<Material> materials(model.materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string at = "materials[" + std::to_string(i) + "]";
    FURROW_RETURN_IF_ERROR(ReadMaterial(model, model.materials[i], at, &materials[i]));
  }
  return materials;
}

}  // namespace furrow::character
