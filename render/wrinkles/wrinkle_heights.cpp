// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/wrinkle_heights.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/gl/mipmaps.h"
#include "render/wrinkles/derivative_map.h"

namespace furrow::render {
namespace {

using character::Picture;

// Resample() works on pairs, so both channels hold the height.
DerivativeMap HeightsOf(const Picture& picture, float height_mm) {
  const bool floats = !picture.pixels_float.empty();
  DerivativeMap map{picture.width, picture.height, {}};
  map.texels.reserve(static_cast<std::size_t>(map.width) * map.height * 2);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const float stored = Texel(picture, x, y, 0);
      const float height = floats ? stored : (2.0f * stored - 1.0f) * height_mm;
      map.texels.push_back(height);
      map.texels.push_back(height);
    }
  }
  return map;
}

}  // namespace

WrinkleHeights MakeWrinkleHeights(const character::Character& character) {
  WrinkleHeights heights;
  std::vector<DerivativeMap> maps;
  int width = 1;
  int height = 1;
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    const int index = map.height.empty() ? -1 : character.FindRigPicture(map.height);
    heights.layers.push_back(index < 0 ? -1 : static_cast<int>(maps.size()));
    if (index < 0) continue;
    maps.push_back(HeightsOf(character.pictures[static_cast<std::size_t>(index)], map.height_mm));
    width = std::max(width, maps.back().width);
    height = std::max(height, maps.back().height);
    for (const float texel : maps.back().texels) {
      heights.max_mm = std::max(heights.max_mm, map.amplitude * std::abs(texel));
    }
  }
  if (maps.empty()) return heights;
  heights.side = std::max(width, height);
  heights.texture = gl::MakeTexture(GL_TEXTURE_2D_ARRAY);
  const GLuint name = heights.texture.name();
  glTextureStorage3D(name, std::bit_width(static_cast<unsigned>(heights.side)), GL_R16F, width,
                     height, static_cast<GLsizei>(maps.size()));
  for (std::size_t layer = 0; layer < maps.size(); ++layer) {
    const DerivativeMap map = Resample(maps[layer], width, height);
    std::vector<float> texels;
    texels.reserve(map.texels.size() / 2);
    for (std::size_t i = 0; i < map.texels.size(); i += 2) texels.push_back(map.texels[i]);
    gl::UploadWithMips({name, static_cast<int>(layer), width, height}, std::move(texels), 1);
  }
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_REPEAT);
  return heights;
}

}  // namespace furrow::render
