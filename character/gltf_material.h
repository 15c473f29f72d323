// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "character/character.h"

namespace tinygltf {
class Model;
}

namespace furrow::character {

inline constexpr std::size_t kMaxPictures = 64;
inline constexpr std::size_t kMaxMaterials = 1024;

// What a material is made of by its name, where the file does not say: "skin", "face", "head" and
// "body" are skin; "eye" and "cornea" eyes; "hair", "lash", "brow" and "beard" hair; "cloth",
// "suit", "shirt", "jeans" and the like cloth.
[[nodiscard]] Material::Kind GuessMaterialKind(std::string_view name);
[[nodiscard]] std::string_view MaterialKindName(Material::Kind kind);  // "skin", "cloth", ...

// All pictures of the file in its order, decoded: from buffer views, data URIs or (a .gltf's) files
// found by FindAsset(). `where` of an error: "images[2]". Read leniently, a picture that is absent or
// damaged is noted and has no pixels; limits hold all the same.
[[nodiscard]] Result<std::vector<Picture>> ReadGltfPictures(const tinygltf::Model& model,
                                                            const std::filesystem::path& folder,
                                                            const ReadOptions& options = {});

// Materials; the kind is the extra "furrow_kind" or a guess. Texture indices are into the pictures.
[[nodiscard]] Result<std::vector<Material>> ReadGltfMaterials(const tinygltf::Model& model);

}  // namespace furrow::character
