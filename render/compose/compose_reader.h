// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/compose/compose_job.h"
#include "render/compose/skinned_masks.h"
#include "render/scene/gpu_character.h"

namespace furrow::render {

// What is composed of a material: the wrinkle maps (of the rig) that may go on it, and the channels
// of the masks (four a layer) that say where; both ascending. Channels of skinned masks count on
// from there.
struct ComposeSelection {
  const GpuMaterial* material = nullptr;
  std::vector<int> maps;
  std::vector<int> channels;
  const SkinnedMasks* skinned = nullptr;  // null: none

  [[nodiscard]] std::size_t num_channels() const {
    return channels.size() + (skinned == nullptr ? 0 : skinned->channels().size());
  }
};

// Textures of a character as a level of `size` texels sees them, from the same levels of each,
// where some mask lets something through: row after row. Needs a current context, and waits for it.
[[nodiscard]] std::vector<ComposeTile> ReadComposeTiles(const GpuCharacter& gpu,
                                                        const ComposeSelection& selection,
                                                        glm::ivec2 size);

// RGBA halves of a material's textures in that size: what ComposeJob writes where nothing is
// painted. Without looks, `colours` stays empty.
struct BareTexels {
  std::vector<std::uint16_t> slopes;
  std::vector<std::uint16_t> colours;
};
[[nodiscard]] BareTexels ReadBareTexels(const GpuCharacter& gpu, const GpuMaterial& material,
                                        glm::ivec2 size);

// Of a texture's finest level; 0 x 0: there is none.
[[nodiscard]] glm::ivec2 TextureSize(GLuint texture);

}  // namespace furrow::render
