// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "base/status.h"
#include "character/character.h"
#include "character/gltf/gltf_skeleton.h"
#include "character/source_notes.h"

namespace furrow::character {

// Reads the glTF part of a character: name (of the scene), skeleton, meshes, shapes, materials,
// pictures and warnings. `bytes`: a whole .glb or .gltf file. `folder`: holds the files that it
// names. `where` of errors is a field. After an error, `character` is partly filled; discard it.
[[nodiscard]] Status ReadGltfCharacter(std::string_view bytes, const std::filesystem::path& folder,
                                       const ReadOptions& options, Character* character);

// Reads only the names and the roles of the joints of a whole file.
[[nodiscard]] Result<NamedRoles> ReadGltfRoles(std::string_view bytes,
                                               const std::filesystem::path& folder);

}  // namespace furrow::character
