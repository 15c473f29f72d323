// SPDX-License-Identifier: Apache-2.0
// assimp's headers stay in this folder: what leaves it is glTF.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include <assimp/material.h>
#include <assimp/scene.h>

#include "authoring/import/assimp/gltf_pieces.h"
#include "character/gltf_builder.h"

namespace furrow::authoring {

// Names from outside may be in any encoding; JSON takes UTF-8 alone: what is not printable ASCII is
// an underscore.
[[nodiscard]] std::string NameFrom(const aiString& name);

// A scene's materials on their way to glTF: base colour, roughness, the pictures of base colour and
// normals, two-sidedness.
class AssimpMaterials {
 public:
  // Both outlive it. Materials, textures and images are appended to the builder's root, materials
  // in the scene's order.
  AssimpMaterials(const aiScene& scene, character::GltfBuilder* builder)
      : scene_(scene), builder_(*builder), root_(builder->root()) {}

  // Appends a remark for each picture that is left out.
  void Run(std::vector<std::string>* remarks);

 private:
  [[nodiscard]] GltfJson Material(const aiMaterial& from);
  // The texture of the first of `types` that the material has; -1 for none.
  int TextureOf(const aiMaterial& material, std::initializer_list<aiTextureType> types);
  int AddTexture(const aiString& path);

  const aiScene& scene_;
  character::GltfBuilder& builder_;
  GltfJson& root_;
  std::map<std::string, int> texture_by_path_;
  std::vector<std::string> remarks_;
};

}  // namespace furrow::authoring
