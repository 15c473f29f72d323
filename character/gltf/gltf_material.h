// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "character/character.h"
#include "character/source_notes.h"
#include "gltf/document/document.h"

namespace furrow::character {

// The kind of a material by words in its name, for files that do not state it: "skin", "face",
// "head" and "body" are skin; "eye" and "cornea" are eyes; "hair", "lash", "brow" and "beard" are
// hair; "cloth", "suit", "shirt", "jeans" and similar words are cloth.
[[nodiscard]] Material::Kind GuessMaterialKind(std::string_view name);
[[nodiscard]] std::string_view MaterialKindName(Material::Kind kind);  // "skin", "cloth", ...

// All images of the file, decoded, in the file's order.
//
// With options.lenient, an image that is missing or damaged is noted and has no pixels. Limits
// still apply. Errors: gltf::LocateImage()'s, DecodePicture()'s, kLimit (too many pixels
// together). `where` is "images[2]".
[[nodiscard]] Result<std::vector<Picture>> ReadGltfPictures(const gltf::Document& document,
                                                            const ReadOptions& options = {});

// All materials. The kind is the extra "furrow_kind", or guessed from the name. Texture indices
// refer to the pictures. Errors: gltf::ReadMaterials()'s.
[[nodiscard]] Result<std::vector<Material>> ReadGltfMaterials(const gltf::Document& document);

}  // namespace furrow::character
