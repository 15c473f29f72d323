// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/mesh_builder.h"
#include "authoring/import/makehuman/proxy.h"
#include "authoring/import/makehuman/save/asset_library.h"
#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// A part of a saved person (eyes, hair, a garment, ...) and its look.
struct SavedPart {
  std::string kind;  // "eyes", "hair", "clothes", ...
  std::string name;
  Proxy proxy;
  std::optional<character::Picture> colour;  // sRGB, 8 bits, with alpha if `transparent`
  std::optional<character::Picture> normal;  // tangent space, 8 bits, green up
  glm::vec3 tint{1.0f};                      // sRGB; multiplies the picture
  bool transparent = false;
  bool double_sided = false;
  bool painted = false;  // a garment or hair without its picture; the import paints one
};

// Finds and reads the parts of a save. Each part is used whole or not at all:
//
// - A garment without its picture is painted as cloth, hair as strands. All other parts need the
//   picture, since their shape is in its alpha; without it Furrow's own part is used instead.
// - Clothes are sorted from the inside to the outside. A repeated garment is worn once; of other
//   parts of one kind, the last is used, as in MakeHuman.
// - Pictures larger than `texture_size` are reduced to at most that width and height.
//
// `num_base_vertices`: of the base mesh. A part that is not found or not readable is a warning that
// names the part, the file and the remedy.
[[nodiscard]] std::vector<SavedPart> ReadSavedParts(const MhmSave& save, AssetLibrary* library,
                                                    std::size_t num_base_vertices, int texture_size,
                                                    std::vector<std::string>* warnings);

// True if one of `parts` is of the kind.
[[nodiscard]] bool HasKind(std::span<const SavedPart> parts, std::string_view kind);

// For each base vertex, whether one of `parts` hides it; empty if `parts` is.
[[nodiscard]] std::vector<bool> HiddenBy(std::span<const SavedPart> parts);

// The material of a part, without textures. Clothes are cloth, brows and lashes are hair.
[[nodiscard]] character::Material MaterialOf(const SavedPart& part);

// The picture of the save's skin; nullopt if the save names none or the picture is not readable,
// with a warning. It has the UV layout of base.obj.
[[nodiscard]] std::optional<character::Picture> ReadSavedSkin(const MhmSave& save,
                                                              const AssetLibrary& library,
                                                              std::vector<std::string>* warnings);

// Moves a skin's picture from the UV layout of base.obj to that of BuildSkin(). `texels` cover the
// skin; `moves`: those of BuildSkin(). `size`: width and height of the result. Texels are means of
// the area that they cover in `picture`.
[[nodiscard]] character::Picture MoveSkinPicture(const character::Picture& picture,
                                                 const std::vector<SurfaceTexel>& texels,
                                                 std::span<const UvMove> moves, int size);

}  // namespace furrow::authoring
