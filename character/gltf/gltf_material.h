// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "character/character.h"
#include "character/source_notes.h"
#include "gltf/document/document.h"
#include "gltf/scene/materials.h"

namespace furrow::character {

// Guesses the kind of a material from words in its name, for files that do not state the kind:
// "skin", "face", "head" and "body" are skin; "eye" and "cornea" are eyes; "hair", "lash", "brow"
// and "beard" are hair; "cloth", "suit", "shirt", "jeans" and similar words are cloth. kOther if no
// word matches.
[[nodiscard]] Material::Kind GuessMaterialKind(std::string_view name);
// The lowercase name: "skin", "cloth", "eye", "hair", "other" or "shade".
[[nodiscard]] std::string_view MaterialKindName(Material::Kind kind);

// Decodes the images of the file that options.pictures asks for, in the file's order. The others
// become pictures without pixels (Undecoded()). `materials`: all of the file.
//
// With options.lenient, an image that is missing or damaged is listed in the notes and becomes a
// picture without pixels. Limits still apply. Errors: those of gltf::LocateImage() and
// DecodePicture(), and kLimit (too many pixels together). `where` of errors is "images[2]".
[[nodiscard]] Result<std::vector<Picture>> ReadGltfPictures(
    const gltf::Document& document, std::span<const gltf::Material> materials,
    const ReadOptions& options = {});

// The file's materials, in its order. The kind is the glTF extra "furrow_kind", or guessed from the
// name. Texture indices count the results of ReadGltfPictures(). Their UV transforms are in the
// meshes; see ReadGltfMeshes().
[[nodiscard]] std::vector<Material> MakeGltfMaterials(const std::vector<gltf::Material>& from);

}  // namespace furrow::character
