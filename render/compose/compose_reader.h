// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/compose/compose_job.h"
#include "render/compose/skinned_masks.h"
#include "render/scene/gpu_character.h"

namespace furrow::render {

// Selects what is composed into a material's textures. The channel numbers of ComposeTile::Mask
// count the entries of `channels` first and then the channels of `skinned`. The pointers belong to
// the caller.
struct ComposeSelection {
  const GpuMaterial* material = nullptr;
  std::vector<int> maps;                  // indices of the rig's wrinkle maps, ascending
  std::vector<int> channels;              // of the mask textures, four per layer; ascending
  const SkinnedMasks* skinned = nullptr;  // masks by skin weight; null: none

  [[nodiscard]] std::size_t num_channels() const {
    return channels.size() + (skinned == nullptr ? 0 : skinned->channels().size());
  }
};

// Reads the textures of a character at the mip level of `size` texels back from the GPU. Returns
// the tiles where a mask is above 0, row by row. Needs a current context; blocks until the data
// arrives.
[[nodiscard]] std::vector<ComposeTile> ReadComposeTiles(const GpuCharacter& gpu,
                                                        const ComposeSelection& selection,
                                                        glm::ivec2 size);

// What ComposeJob writes where no wrinkle is drawn: four half floats per texel of a material's base
// textures. `colours` is empty if no wrinkle map changes colours.
struct BaseTexels {
  std::vector<std::uint16_t> slopes;
  std::vector<std::uint16_t> colours;
};
// Reads the base textures of `material` at `size` texels. Needs a current context, as above.
[[nodiscard]] BaseTexels ReadBaseTexels(const GpuCharacter& gpu, const GpuMaterial& material,
                                        glm::ivec2 size);

// The size in texels of a texture's finest level; 0 x 0 if `texture` is 0.
[[nodiscard]] glm::ivec2 TextureSize(GLuint texture);

}  // namespace furrow::render
