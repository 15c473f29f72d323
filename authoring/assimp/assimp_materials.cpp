// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/assimp_materials.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <assimp/GltfMaterial.h>

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxPicturesOf = 64;

// The last component of a path with either kind of slash.
std::string FileName(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

float RoughnessOf(const aiMaterial& from) {
  float roughness = 0.6f;
  float shininess = 0.0f;
  if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) != AI_SUCCESS &&
      from.Get(AI_MATKEY_SHININESS, shininess) == AI_SUCCESS && shininess > 0.0f) {
    // Converts a Blinn-Phong exponent to a roughness with the same width of highlight.
    roughness = std::pow(2.0f / (shininess + 2.0f), 0.25f);
  }
  return std::clamp(roughness, 0.0f, 1.0f);
}

aiColor4D ColourOf(const aiMaterial& from) {
  aiColor4D colour(1.0f, 1.0f, 1.0f, 1.0f);
  if (from.Get(AI_MATKEY_BASE_COLOR, colour) != AI_SUCCESS) {
    (void)from.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  }
  return colour;
}

}  // namespace

std::string NameFrom(const aiString& name) {
  std::string text(name.data, std::min<std::size_t>(name.length, 255));
  const auto printable = [](char c) { return static_cast<unsigned char>(c) - 0x20u < 0x5fu; };
  std::replace_if(
      text.begin(), text.end(), [&](char c) { return !printable(c); }, '_');
  return text;
}

void AssimpMaterials::Run(std::vector<std::string>* remarks) {
  for (unsigned m = 0; m < scene_.mNumMaterials; ++m) {
    // Before the list is looked up: a material may add the lists of its textures and images to
    // root_, which moves all others.
    GltfJson material = Material(*scene_.mMaterials[m]);
    root_["materials"].push_back(std::move(material));
  }
  remarks->insert(remarks->end(), remarks_.begin(), remarks_.end());
}

GltfJson AssimpMaterials::Material(const aiMaterial& from) {
  const aiColor4D colour = ColourOf(from);
  GltfJson pbr = {{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0f}},
                  {"metallicFactor", 0},
                  {"roughnessFactor", RoughnessOf(from)}};
  if (const int texture = TextureOf(from, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
      texture >= 0) {
    pbr["baseColorTexture"] = {{"index", texture}};
    pbr["baseColorFactor"] = {1.0f, 1.0f, 1.0f, 1.0f};  // exporters often add a grey of 0.8
  }
  GltfJson material = {{"name", NameFrom(from.GetName())},
                       {"pbrMetallicRoughness", std::move(pbr)}};
  if (const int texture = TextureOf(from, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
      texture >= 0) {
    material["normalTexture"] = {{"index", texture}};
  }
  int two_sided = 0;
  (void)from.Get(AI_MATKEY_TWOSIDED, two_sided);
  if (two_sided != 0) material["doubleSided"] = true;
  return material;
}

int AssimpMaterials::TextureOf(const aiMaterial& material,
                               std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    aiString path;
    if (material.GetTextureCount(type) == 0 || material.GetTexture(type, 0, &path) != AI_SUCCESS)
      continue;
    const auto known = texture_by_path_.find(path.C_Str());
    if (known != texture_by_path_.end()) return known->second;
    return texture_by_path_[path.C_Str()] = AddTexture(path);
  }
  return -1;
}

int AssimpMaterials::AddTexture(const aiString& path) {
  if (root_["textures"].size() >= kMaxPicturesOf) {
    remarks_.push_back("more than " + std::to_string(kMaxPicturesOf) +
                       " pictures; the rest is skipped");
    return -1;
  }
  const aiTexture* embedded = scene_.GetEmbeddedTexture(path.C_Str());
  const std::string name = FileName(NameFrom(path));
  GltfJson image = {{"name", name}};
  if (embedded != nullptr && embedded->mHeight == 0) {
    image["mimeType"] = "image/png";  // a placeholder; readers detect the format by its first bytes
    image["bufferView"] =
        builder_.AddView(embedded->pcData, embedded->mWidth, gltf::Builder::kNoTarget);
  } else if (embedded != nullptr || name.empty()) {
    remarks_.push_back("the picture '" + name + "' is embedded as raw pixels and skipped");
    return -1;
  } else {
    image["uri"] = name;
  }
  root_["images"].push_back(std::move(image));
  root_["textures"].push_back({{"source", root_["images"].size() - 1}});
  return static_cast<int>(root_["textures"].size()) - 1;
}

}  // namespace furrow::authoring
