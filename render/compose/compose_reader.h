// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/compose/compose_job.h"
#include "render/compose/skinned_masks.h"
#include "render/scene/gpu_character.h"

namespace furrow::render {

// Selects what is composed into a material: wrinkle maps of the rig, and the mask channels (four
// per layer) that mask them. Both lists are ascending. Channels of skinned masks are numbered after
// `channels`.
struct ComposeSelection {
  const GpuMaterial* material = nullptr;
  std::vector<int> maps;
  std::vector<int> channels;
  const SkinnedMasks* skinned = nullptr;  // null: none

  [[nodiscard]] std::size_t num_channels() const {
    return channels.size() + (skinned == nullptr ? 0 : skinned->channels().size());
  }
};

// Reads the textures of a character at a mip level of `size` texels and returns the tiles where a
// mask is above 0, row by row. Needs a current context and waits for it.
[[nodiscard]] std::vector<ComposeTile> ReadComposeTiles(const GpuCharacter& gpu,
                                                        const ComposeSelection& selection,
                                                        glm::ivec2 size);

// RGBA half floats of a material's own textures at that size: what ComposeJob writes where nothing
// is painted. `colours` is empty if no wrinkle map has looks.
struct BaseTexels {
  std::vector<std::uint16_t> slopes;
  std::vector<std::uint16_t> colours;
};
[[nodiscard]] BaseTexels ReadBaseTexels(const GpuCharacter& gpu, const GpuMaterial& material,
                                        glm::ivec2 size);

// Size of a texture's finest level; 0 x 0 if there is no texture.
[[nodiscard]] glm::ivec2 TextureSize(GLuint texture);

}  // namespace furrow::render
