// SPDX-License-Identifier: Apache-2.0
// Includes assimp's headers, which stay in this folder: other code sees glTF.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include <assimp/material.h>
#include <assimp/scene.h>

#include "authoring/assimp/gltf_pieces.h"
#include "gltf/write/builder.h"

namespace furrow::authoring {

// Converts a name to ASCII. Foreign names may have any encoding, but JSON requires UTF-8, so every
// byte that is not printable ASCII becomes an underscore.
[[nodiscard]] std::string NameFrom(const aiString& name);

// Converts a scene's materials to glTF: base colour, roughness, the pictures of base colour and
// normals, double-sidedness.
class AssimpMaterials {
 public:
  // Both arguments must outlive the object.
  AssimpMaterials(const aiScene& scene, gltf::Builder* builder)
      : scene_(scene), builder_(*builder), root_(builder->root()) {}

  // Appends the materials, in the scene's order, with their textures and images to the builder's
  // root. Appends one sentence to `remarks` for each picture that cannot be converted.
  void Run(std::vector<std::string>* remarks);

 private:
  [[nodiscard]] GltfJson Material(const aiMaterial& from);
  // The first texture of the material that has one of `types`, or -1.
  int TextureOf(const aiMaterial& material, std::initializer_list<aiTextureType> types);
  int AddTexture(const aiString& path);

  const aiScene& scene_;
  gltf::Builder& builder_;
  GltfJson& root_;
  std::map<std::string, int> texture_by_path_;
  std::vector<std::string> remarks_;
};

}  // namespace furrow::authoring
