// SPDX-License-Identifier: Apache-2.0
#include "render/compose/compose_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <span>
#include <thread>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>

#include "base/process/in_background.h"
#include "base/srgb.h"
#include "render/wrinkles/half_floats.h"

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

// How a texture stores its four channels.
enum class Stored { kBytes, kSrgbBytes, kHalves };

// The floats of all 256 bytes. sRGB is decoded before any resampling, as a sampler does, because
// filtering is correct in linear light only.
const std::array<float, 256>& DecodedBytes(bool is_srgb) {
  static const std::array<std::array<float, 256>, 2> tables = [] {
    std::array<std::array<float, 256>, 2> values{};
    for (std::size_t i = 0; i < 256; ++i) {
      values[0][i] = static_cast<float>(i) / 255.0f;
      values[1][i] = LinearFromSrgb(values[0][i]);
    }
    return values;
  }();
  return tables[is_srgb ? 1 : 0];
}

// Reads one layer of a texture at a given size, from the level of that size or the next finer one.
// The level is read as it is stored, in one call: the driver copies it without conversion. Callers
// get floats, part by part, resampled if the sizes differ.
class LayerReader {
 public:
  LayerReader(GLuint texture, int layer, Stored stored, glm::ivec2 size)
      : stored_(stored), size_(size), source_(LevelSize(texture, 0)) {
    int level = 0;
    // Stops before a level that is smaller than requested, so resampling never invents detail.
    while (source_.x / 2 >= size.x && source_.y / 2 >= size.y) {
      source_ = LevelSize(texture, ++level);
    }
    const auto read = [&](GLenum type, auto* values) {
      values->resize(4 * Count(source_));
      glGetTextureSubImage(texture, level, 0, 0, layer, source_.x, source_.y, 1, GL_RGBA, type,
                           static_cast<GLsizei>(values->size() * sizeof(values->front())),
                           values->data());
    };
    if (stored == Stored::kHalves) {
      read(GL_HALF_FLOAT, &halves_);
    } else {
      read(GL_UNSIGNED_BYTE, &bytes_);
    }
  }

  // The texels of a rectangle, which lies inside the size.
  [[nodiscard]] Texels Read(glm::ivec2 first, glm::ivec2 part) const {
    return source_ == size_ ? Decoded(first, part) : Resampled(first, part);
  }

  // Texels beyond the border are 0.
  [[nodiscard]] Texels ReadTile(glm::ivec2 place) const {
    const glm::ivec2 first = place * ComposeTile::kSide;
    const glm::ivec2 part = glm::min(size_ - first, glm::ivec2(ComposeTile::kSide));
    Texels read = Read(first, part);
    if (part == glm::ivec2(ComposeTile::kSide)) return read;
    Texels tile(ComposeTile::kTexels, glm::vec4(0.0f));
    for (int y = 0; y < part.y; ++y) {
      std::copy_n(read.begin() + y * part.x, part.x, tile.begin() + y * ComposeTile::kSide);
    }
    return tile;
  }

 private:
  // `count` texels of a row of the stored level.
  void Decode(glm::ivec2 first, int count, glm::vec4* to) const {
    const std::size_t from = 4 * static_cast<std::size_t>(first.y * source_.x + first.x);
    const auto values = 4 * static_cast<std::size_t>(count);
    if (stored_ == Stored::kHalves) {
      return FromHalfFloats(std::span(halves_).subspan(from, values), {&to->x, values});
    }
    const float* const colour = DecodedBytes(stored_ == Stored::kSrgbBytes).data();
    const float* const alpha = DecodedBytes(false).data();
    const std::uint8_t* bytes = &bytes_[from];
    for (int i = 0; i < count; ++i, bytes += 4) {
      to[i] = {colour[bytes[0]], colour[bytes[1]], colour[bytes[2]], alpha[bytes[3]]};
    }
  }

  [[nodiscard]] Texels Decoded(glm::ivec2 first, glm::ivec2 part) const {
    Texels texels(Count(part));
    for (int y = 0; y < part.y; ++y) {
      Decode(first + glm::ivec2(0, y), part.x, &texels[static_cast<std::size_t>(y * part.x)]);
    }
    return texels;
  }

  // Resamples as a bilinear, repeating sampler does.
  [[nodiscard]] Texels Resampled(glm::ivec2 first, glm::ivec2 part) const {
    // Texel centres are at halves, hence the shift before and after scaling.
    const glm::vec2 scale = glm::vec2(source_) / glm::vec2(size_);
    const glm::vec2 begin = (glm::vec2(first) + 0.5f) * scale - 0.5f;
    const auto left = static_cast<int>(std::floor(begin.x));
    const auto count = static_cast<int>(std::floor(begin.x + scale.x * (part.x - 1))) - left + 2;
    Texels upper(static_cast<std::size_t>(count));
    Texels lower(upper.size());
    Texels texels(Count(part));
    for (int y = 0; y < part.y; ++y) {
      const float row = begin.y + scale.y * static_cast<float>(y);
      const auto above = static_cast<int>(std::floor(row));
      DecodeWrapped({left, above}, &upper);
      DecodeWrapped({left, above + 1}, &lower);
      const float share = row - static_cast<float>(above);
      for (std::size_t i = 0; i < upper.size(); ++i) upper[i] += share * (lower[i] - upper[i]);
      glm::vec4* const to = &texels[static_cast<std::size_t>(y * part.x)];
      for (int x = 0; x < part.x; ++x) {
        const float column = begin.x + scale.x * static_cast<float>(x) - static_cast<float>(left);
        // Rounding must not reach beyond the last pair.
        const auto before = std::min(static_cast<std::size_t>(column), upper.size() - 2);
        const glm::vec4& texel = upper[before];
        to[x] = texel + (column - static_cast<float>(before)) * (upper[before + 1] - texel);
      }
    }
    return texels;
  }

  // Decodes the texels of a row from `first` on. Beyond the border follow those of the other side.
  void DecodeWrapped(glm::ivec2 first, Texels* to) const {
    const int y = (first.y + source_.y) % source_.y;
    int x = (first.x + source_.x) % source_.x;
    const auto end = static_cast<int>(to->size());
    for (int done = 0; done < end; x = 0) {
      const int run = std::min(end - done, source_.x - x);
      Decode({x, y}, run, &(*to)[static_cast<std::size_t>(done)]);
      done += run;
    }
  }

  Stored stored_;
  glm::ivec2 size_;
  glm::ivec2 source_;  // size of the stored level
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint16_t> halves_;
};

// Converts `value` of each texel to planes.
template <class Value>
std::vector<std::uint16_t> Planes(const Texels& texels, std::size_t planes, Value value) {
  std::vector<float> floats(texels.size() * planes);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const glm::vec4 values = value(texels[i]);
    for (std::size_t k = 0; k < planes; ++k) {
      floats[k * texels.size() + i] = values[static_cast<int>(k)];
    }
  }
  std::vector<std::uint16_t> halves(floats.size());
  ToHalfFloats(floats, halves);
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

// Calls `change` for every tile, on up to four threads. Reading all folds of a face takes longer
// than drawing it, and the first picture waits for it.
template <class Change>
void ForTiles(std::vector<ComposeTile>* tiles, const Change& change) {
  const std::size_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, 4u);
  const std::size_t share = tiles->size() / threads + 1;
  const auto change_from = [&](std::size_t first) {
    const std::size_t end = std::min(first + share, tiles->size());
    for (std::size_t i = first; i < end; ++i) change(&(*tiles)[i]);
  };
  std::vector<std::future<void>> others;
  for (std::size_t first = share; first < tiles->size(); first += share) {
    others.push_back(InBackground([&change_from, first] { change_from(first); }));
  }
  change_from(0);
  for (std::future<void>& other : others) other.get();
}

// Adds a mask channel to a tile if it is above 0 there. `number`: of the channel in the selection.
void AddMask(const Texels& texels, int channel, std::size_t number, ComposeTile* tile) {
  ComposeTile::Mask mask{number, std::vector<std::uint8_t>(ComposeTile::kTexels)};
  bool is_any = false;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    mask.values[i] = static_cast<std::uint8_t>(texels[i][channel] * 255.0f + 0.5f);
    is_any = is_any || mask.values[i] > 0;
  }
  if (is_any) tile->masks.push_back(std::move(mask));
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
  // Channels are ascending, so each layer is read once.
  for (std::size_t first = 0; first < channels.size();) {
    const int layer = channels[first] / 4;
    std::size_t end = first;
    while (end < channels.size() && channels[end] / 4 == layer) ++end;
    const LayerReader reader(gpu.masks(), layer, Stored::kBytes, size);
    ForTiles(&tiles, [&](ComposeTile* tile) {
      const Texels texels = reader.ReadTile(tile->place);
      for (std::size_t i = first; i < end; ++i) AddMask(texels, channels[i] % 4, i, tile);
    });
    first = end;
  }
  if (selection.skinned != nullptr) selection.skinned->AddTo(size, channels.size(), &tiles);
  std::erase_if(tiles,
                [](const ComposeTile& tile) { return tile.masks.empty() && tile.skinned.empty(); });
  return tiles;
}

// Passes each tile its texels of a texture, or `without` for all of them if there is no texture.
template <class Give>
void GiveTexels(GLuint texture, Stored stored, const glm::vec4& without, glm::ivec2 size,
                std::vector<ComposeTile>* tiles, Give give) {
  if (texture == 0) {
    const Texels none(ComposeTile::kTexels, without);
    return ForTiles(tiles, [&](ComposeTile* tile) { give(tile, none); });
  }
  const LayerReader reader(texture, 0, stored, size);
  ForTiles(tiles, [&](ComposeTile* tile) { give(tile, reader.ReadTile(tile->place)); });
}

void ReadSurface(const GpuCharacter& gpu, const GpuMaterial& material, glm::ivec2 size,
                 std::vector<ComposeTile>* tiles) {
  GiveTexels(
      material.derivatives, Stored::kHalves, glm::vec4(0.0f), size, tiles,
      [](ComposeTile* tile, const Texels& texels) { tile->slopes = Planes(texels, 3, SlopeOf); });
  if (gpu.wrinkle_looks() == 0) return;
  GiveTexels(material.base_colour, Stored::kSrgbBytes, glm::vec4(1.0f), size, tiles,
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
  const LayerReader slopes(gpu.wrinkle_derivatives(), layer, Stored::kHalves, size);
  ForTiles(tiles, [&](ComposeTile* tile) {
    tile->maps.push_back({Planes(slopes.ReadTile(tile->place), 3, SlopeOf), {}});
  });
  if (gpu.wrinkle_looks() == 0) return;
  const LayerReader looks(gpu.wrinkle_looks(), map, Stored::kSrgbBytes, size);
  ForTiles(tiles, [&](ComposeTile* tile) {
    tile->maps.back().looks = Planes(looks.ReadTile(tile->place), 4, Same);
  });
}

// RGBA texel by texel, the layout of an upload. ComposeJob needs planes instead. Converts row by
// row, because a whole level of floats is large.
std::vector<std::uint16_t> Interleaved(const LayerReader& reader, glm::ivec2 size, bool is_opaque) {
  std::vector<std::uint16_t> halves(4 * Count(size));
  const auto values = 4 * static_cast<std::size_t>(size.x);
  for (int y = 0; y < size.y; ++y) {
    Texels row = reader.Read({0, y}, {size.x, 1});
    for (glm::vec4& texel : row) texel.a = is_opaque ? 1.0f : texel.a;
    ToHalfFloats({&row[0].x, values},
                 std::span(halves).subspan(static_cast<std::size_t>(y) * values, values));
  }
  return halves;
}

std::vector<std::uint16_t> Uniform(float value, glm::ivec2 size) {
  return std::vector<std::uint16_t>(4 * Count(size), glm::packHalf1x16(value));
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
  // Alpha is 1 where a colour has no cavity.
  const auto read = [&](GLuint texture, Stored stored, bool is_colour) {
    if (texture == 0) return Uniform(is_colour ? 1.0f : 0.0f, size);
    return Interleaved(LayerReader(texture, 0, stored, size), size, is_colour);
  };
  BaseTexels base;
  base.slopes = read(material.derivatives, Stored::kHalves, false);
  if (gpu.wrinkle_looks() == 0) return base;
  base.colours = read(material.base_colour, Stored::kSrgbBytes, true);
  return base;
}

}  // namespace furrow::render
