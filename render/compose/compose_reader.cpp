// SPDX-License-Identifier: Apache-2.0
#include "render/compose/compose_reader.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>

#include "base/srgb.h"

namespace furrow::render {
namespace {

using Texels = std::vector<glm::vec4>;

// GpuCharacter keeps no sizes, so the driver is asked.
glm::ivec2 LevelSize(GLuint texture, int level) {
  glm::ivec2 size(0);
  glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_WIDTH, &size.x);
  glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_HEIGHT, &size.y);
  return size;
}

std::size_t Count(glm::ivec2 size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

// Decodes sRGB through a table of all 256 byte values.
// Reading back returns the stored sRGB bytes. They are decoded before any resampling, as a sampler
// does, because filtering is correct in linear light only.
void DecodeSrgb(Texels* texels) {
  static const std::vector<float> decoded = [] {
    std::vector<float> table;
    for (int i = 0; i < 256; ++i) table.push_back(LinearFromSrgb(static_cast<float>(i) / 255.0f));
    return table;
  }();
  for (glm::vec4& texel : *texels) {
    for (int k = 0; k < 3; ++k)
      texel[k] = decoded[static_cast<std::size_t>(texel[k] * 255.0f + 0.5f)];
  }
}

// Resamples to `size` texels as a bilinear, repeating sampler does.
Texels Resampled(const Texels& from, glm::ivec2 from_size, glm::ivec2 size) {
  const auto at = [&](int x, int y) {
    const int column = (x + from_size.x) % from_size.x;
    const int row = (y + from_size.y) % from_size.y;
    return from[static_cast<std::size_t>(row * from_size.x + column)];
  };
  Texels texels;
  texels.reserve(Count(size));
  // Texel centres are at halves, hence the shift before and after scaling.
  const glm::vec2 scale = glm::vec2(from_size) / glm::vec2(size);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::vec2 place = (glm::vec2(x, y) + 0.5f) * scale - 0.5f;
      const glm::ivec2 low(glm::floor(place));
      const glm::vec2 share = place - glm::vec2(low);
      const glm::vec4 upper = glm::mix(at(low.x, low.y), at(low.x + 1, low.y), share.x);
      const glm::vec4 lower = glm::mix(at(low.x, low.y + 1), at(low.x + 1, low.y + 1), share.x);
      texels.push_back(glm::mix(upper, lower, share.y));
    }
  }
  return texels;
}

// Reads one layer of a texture at a given size, from the level of that size or the next finer one.
// Reads tile by tile, or, if it must resample, through a copy of the whole level.
class LayerReader {
 public:
  LayerReader(GLuint texture, int layer, bool is_srgb, glm::ivec2 size)
      : texture_(texture), layer_(layer), is_srgb_(is_srgb), size_(size) {
    glm::ivec2 source = LevelSize(texture, 0);
    // Stops before a level that is smaller than requested, so resampling never invents detail.
    while (source.x / 2 >= size.x && source.y / 2 >= size.y) {
      source = LevelSize(texture, ++level_);
    }
    if (source != size) all_ = Resampled(Read({0, 0}, source), source, size);
  }

  [[nodiscard]] Texels ReadAll() const { return all_.empty() ? Read({0, 0}, size_) : all_; }

  // Texels beyond the border are 0.
  [[nodiscard]] Texels ReadTile(glm::ivec2 place) const {
    const glm::ivec2 first = place * ComposeTile::kSide;
    const glm::ivec2 part = glm::min(size_ - first, glm::ivec2(ComposeTile::kSide));
    Texels tile(ComposeTile::kTexels, glm::vec4(0.0f));
    const Texels read = all_.empty() ? Read(first, part) : Texels();
    for (int y = 0; y < part.y; ++y) {
      const auto from = all_.empty() ? read.begin() + y * part.x
                                     : all_.begin() + (first.y + y) * size_.x + first.x;
      std::copy_n(from, part.x, tile.begin() + y * ComposeTile::kSide);
    }
    return tile;
  }

 private:
  [[nodiscard]] Texels Read(glm::ivec2 first, glm::ivec2 part) const {
    Texels texels(Count(part));
    glGetTextureSubImage(texture_, level_, first.x, first.y, layer_, part.x, part.y, 1, GL_RGBA,
                         GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)),
                         texels.data());
    if (is_srgb_) DecodeSrgb(&texels);
    return texels;
  }

  GLuint texture_;
  int layer_;
  bool is_srgb_;
  glm::ivec2 size_;
  int level_ = 0;
  Texels all_;  // empty if the level has the right size
};

// Converts `value` of each texel to planes.
template <class Value>
std::vector<std::uint16_t> Planes(const Texels& texels, std::size_t planes, Value value) {
  std::vector<std::uint16_t> halves(texels.size() * planes);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const glm::vec4 values = value(texels[i]);
    for (std::size_t k = 0; k < planes; ++k) {
      halves[k * texels.size() + i] = glm::packHalf1x16(values[static_cast<int>(k)]);
    }
  }
  return halves;
}

// Same as slopeOf() of shaders/wrinkles/wrinkles_frag.glsl.
glm::vec4 SlopeOf(const glm::vec4& moments) {
  const glm::vec2 slope(moments);
  const glm::vec2 variance =
      glm::max(glm::vec2(moments.b, moments.a) - slope * slope, glm::vec2(0.0f));
  return {slope, 0.5f * (variance.x + variance.y), 0.0f};
}

glm::vec4 Same(const glm::vec4& texel) { return texel; }

// Tiles at the right and bottom edges may be partly outside the level.
glm::ivec2 TilesOf(glm::ivec2 size) { return (size + ComposeTile::kSide - 1) / ComposeTile::kSide; }

// Adds a mask channel to each tile where it is above 0. Tiles are in row order.
void AddMasks(const Texels& layer, int channel, std::size_t number, glm::ivec2 size,
              std::vector<ComposeTile>* tiles) {
  for (ComposeTile& tile : *tiles) {
    ComposeTile::Mask mask{number, std::vector<std::uint8_t>(ComposeTile::kTexels)};
    const glm::ivec2 first = tile.place * ComposeTile::kSide;
    const glm::ivec2 part = glm::min(size - first, glm::ivec2(ComposeTile::kSide));
    bool is_any = false;
    for (int y = 0; y < part.y; ++y) {
      for (int x = 0; x < part.x; ++x) {
        const glm::vec4& texel =
            layer[static_cast<std::size_t>((first.y + y) * size.x + first.x + x)];
        const auto value = static_cast<std::uint8_t>(texel[channel] * 255.0f + 0.5f);
        mask.values[static_cast<std::size_t>(y * ComposeTile::kSide + x)] = value;
        is_any = is_any || value > 0;
      }
    }
    if (is_any) tile.masks.push_back(std::move(mask));
  }
}

// Reads masks first: a tile without any mask cannot have wrinkles and is dropped.
std::vector<ComposeTile> ReadMasks(const GpuCharacter& gpu, const ComposeSelection& selection,
                                   glm::ivec2 size) {
  const std::vector<int>& channels = selection.channels;
  const glm::ivec2 across = TilesOf(size);
  std::vector<ComposeTile> tiles(Count(across));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const int index = static_cast<int>(i);
    tiles[i].place = {index % across.x, index / across.x};
  }
  int layer = -1;
  Texels texels;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    // Channels are ascending, so each layer is read once.
    if (channels[i] / 4 != layer) {
      layer = channels[i] / 4;
      texels = LayerReader(gpu.masks(), layer, false, size).ReadAll();
    }
    AddMasks(texels, channels[i] % 4, i, size, &tiles);
  }
  if (selection.skinned != nullptr) selection.skinned->AddTo(size, channels.size(), &tiles);
  std::erase_if(tiles,
                [](const ComposeTile& tile) { return tile.masks.empty() && tile.skinned.empty(); });
  return tiles;
}

// Passes each tile its texels of a texture, or `without` for all of them if there is no texture.
template <class Give>
void ForTiles(GLuint texture, bool is_srgb, const glm::vec4& without, glm::ivec2 size,
              std::vector<ComposeTile>* tiles, Give give) {
  if (texture == 0) {
    const Texels none(ComposeTile::kTexels, without);
    for (ComposeTile& tile : *tiles) give(&tile, none);
    return;
  }
  const LayerReader reader(texture, 0, is_srgb, size);
  for (ComposeTile& tile : *tiles) give(&tile, reader.ReadTile(tile.place));
}

void ReadSurface(const GpuCharacter& gpu, const GpuMaterial& material, glm::ivec2 size,
                 std::vector<ComposeTile>* tiles) {
  ForTiles(
      material.derivatives, false, glm::vec4(0.0f), size, tiles,
      [](ComposeTile* tile, const Texels& texels) { tile->slopes = Planes(texels, 3, SlopeOf); });
  if (gpu.wrinkle_looks() == 0) return;
  ForTiles(material.base_colour, true, glm::vec4(1.0f), size, tiles,
           [&](ComposeTile* tile, const Texels& texels) {
             tile->colour = Planes(texels, 3, Same);
             tile->cavity_albedo = material.cavity_albedo;
           });
}

// Every tile gets every map of the selection, so that positions in `maps` agree with
// ComposeStrengths.
void ReadMap(const GpuCharacter& gpu, int map, glm::ivec2 size, std::vector<ComposeTile>* tiles) {
  // A map without a texture has amplitude 0, so any layer serves.
  const int layer = std::max(gpu.layout().map_layers[static_cast<std::size_t>(map)], 0);
  const LayerReader slopes(gpu.wrinkle_derivatives(), layer, false, size);
  for (ComposeTile& tile : *tiles) {
    tile.maps.push_back({Planes(slopes.ReadTile(tile.place), 3, SlopeOf), {}});
  }
  if (gpu.wrinkle_looks() == 0) return;
  const LayerReader looks(gpu.wrinkle_looks(), map, true, size);
  for (ComposeTile& tile : *tiles) {
    tile.maps.back().looks = Planes(looks.ReadTile(tile.place), 4, Same);
  }
}

// RGBA texel by texel, the layout of an upload. ComposeJob needs planes instead.
std::vector<std::uint16_t> Interleaved(const Texels& texels) {
  std::vector<std::uint16_t> halves;
  halves.reserve(4 * texels.size());
  for (const glm::vec4& texel : texels) {
    for (int k = 0; k < 4; ++k) halves.push_back(glm::packHalf1x16(texel[k]));
  }
  return halves;
}

}  // namespace

glm::ivec2 TextureSize(GLuint texture) {
  return texture == 0 ? glm::ivec2(0) : LevelSize(texture, 0);
}

std::vector<ComposeTile> ReadComposeTiles(const GpuCharacter& gpu,
                                          const ComposeSelection& selection, glm::ivec2 size) {
  std::vector<ComposeTile> tiles = ReadMasks(gpu, selection, size);
  ReadSurface(gpu, *selection.material, size, &tiles);
  for (const int map : selection.maps) ReadMap(gpu, map, size, &tiles);
  return tiles;
}

BaseTexels ReadBaseTexels(const GpuCharacter& gpu, const GpuMaterial& material, glm::ivec2 size) {
  const auto read = [&](GLuint texture, bool is_srgb) {
    if (texture == 0) return Texels(Count(size), glm::vec4(is_srgb ? 1.0f : 0.0f));
    return LayerReader(texture, 0, is_srgb, size).ReadAll();
  };
  BaseTexels base;
  base.slopes = Interleaved(read(material.derivatives, false));
  if (gpu.wrinkle_looks() == 0) return base;
  Texels colours = read(material.base_colour, true);
  for (glm::vec4& texel : colours) texel.a = 1.0f;  // no cavity
  base.colours = Interleaved(colours);
  return base;
}

}  // namespace furrow::render
