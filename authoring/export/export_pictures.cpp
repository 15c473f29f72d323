// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "authoring/export/painted_mask.h"

namespace furrow::authoring {
namespace {

using character::Picture;

constexpr float kLeastHeight = 1e-3f;  // millimetres
constexpr float kLeastDerivative = 1e-3f;

// A picture without texels yet, with room for all of them in the list that `bits` selects. A normal
// map of 4096 x 4096 texels and 16 bits has 100 MB, and would take twice as much while it grows.
Picture EmptyPicture(int width, int height, int channels, int bits) {
  Picture picture{.name = {},
                  .width = width,
                  .height = height,
                  .channels = channels,
                  .pixels = {},
                  .pixels16 = {},
                  .pixels_float = {}};
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                            static_cast<std::size_t>(channels);
  if (bits == 16) {
    picture.pixels16.reserve(count);
  } else {
    picture.pixels.reserve(count);
  }
  return picture;
}

// Appends a value in [0, 1] to the list that `bits` selects.
void Append(float value, int bits, Picture* picture) {
  const float unit = std::clamp(value, 0.0f, 1.0f);
  if (bits == 16) {
    picture->pixels16.push_back(static_cast<std::uint16_t>(std::lround(unit * 65535.0f)));
  } else {
    picture->pixels.push_back(static_cast<std::uint8_t>(std::lround(unit * 255.0f)));
  }
}

// One channel at a UV, bilinear, clamped at the edges. Equal sizes give the texels themselves.
float Sample(const Picture& picture, int channel, float u, float v) {
  const float x = u * static_cast<float>(picture.width) - 0.5f;
  const float y = v * static_cast<float>(picture.height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const auto at = [&](int column, int row) {
    return render::Texel(picture, std::clamp(column, 0, picture.width - 1),
                         std::clamp(row, 0, picture.height - 1), channel);
  };
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), fx),
                  glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), fx), fy);
}

}  // namespace

Picture NormalMapPicture(const render::DerivativeMap& slopes, const NormalFormat& format) {
  Picture picture = EmptyPicture(slopes.width, slopes.height, 3, format.bits);
  const float up = format.green_down ? -1.0f : 1.0f;
  for (std::size_t i = 0; i + 1 < slopes.texels.size(); i += 2) {
    const glm::vec3 normal =
        glm::normalize(glm::vec3(slopes.texels[i], up * slopes.texels[i + 1], 1.0f));
    for (int c = 0; c < 3; ++c) Append(0.5f * normal[c] + 0.5f, format.bits, &picture);
  }
  return picture;
}

DerivativePicture DerivativeMapPicture(const render::DerivativeMap& slopes,
                                       const NormalFormat& format) {
  DerivativePicture map{EmptyPicture(slopes.width, slopes.height, 3, format.bits),
                        kLeastDerivative};
  for (const float slope : slopes.texels) map.scale = std::max(map.scale, std::abs(slope));
  const float up = format.green_down ? -1.0f : 1.0f;
  for (std::size_t i = 0; i + 1 < slopes.texels.size(); i += 2) {
    Append(0.5f - 0.5f * slopes.texels[i] / map.scale, format.bits, &map.picture);
    Append(0.5f - 0.5f * up * slopes.texels[i + 1] / map.scale, format.bits, &map.picture);
    Append(0.0f, format.bits, &map.picture);
  }
  return map;
}

render::DerivativeMap SlopesOf(const character::Character& character, const ExportPlan::Map& map) {
  const auto picture = [&](int index) -> const Picture& {
    return character.pictures[static_cast<std::size_t>(index)];
  };
  if (map.normal >= 0) return render::DerivativesFromNormalMap(picture(map.normal));
  const float scale =
      character.rig.wrinkle_maps[static_cast<std::size_t>(map.map)].derivative_scale;
  return render::DerivativesFromDerivativeMap(picture(map.derivative), scale);
}

HeightMap HeightMapOf(const Picture& source, float millimetres) {
  const bool floats = !source.pixels_float.empty();
  HeightMap map{EmptyPicture(source.width, source.height, 1, 16), millimetres};
  if (floats) {
    map.millimetres = kLeastHeight;
    for (int y = 0; y < source.height; ++y) {
      for (int x = 0; x < source.width; ++x) {
        map.millimetres = std::max(map.millimetres, std::abs(render::Texel(source, x, y, 0)));
      }
    }
  }
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) {
      const float texel = render::Texel(source, x, y, 0);
      Append(floats ? 0.5f + 0.5f * texel / map.millimetres : texel, 16, &map.picture);
    }
  }
  return map;
}

Picture MaskPicture(const character::Character& character, const ExportPlan::Mask& mask,
                    std::vector<std::string>* shared) {
  Picture picture = EmptyPicture(mask.width, mask.height, 4, 8);
  struct Source {
    const Picture* picture = nullptr;
    int channel = 0;
  };
  std::array<Picture, 4> painted;  // masks by skin weights, and sliding ones
  std::array<Source, 4> sources;
  for (std::size_t c = 0; c < 4; ++c) {
    if (mask.regions[c] < 0) continue;
    const wrinkle::Region& region =
        character.rig.regions[static_cast<std::size_t>(mask.regions[c])];
    if (region.mask.kind != wrinkle::Mask::Kind::kTexture) {
      PaintedMask from_surface = PaintMask(character, region, kPaintedMaskSide);
      if (from_surface.is_shared) shared->push_back(region.name);
      painted[c] = std::move(from_surface.picture);
      sources[c] = {&painted[c], 0};
    } else {
      const int index = character.FindRigPicture(region.mask.texture);
      sources[c] = {&character.pictures[static_cast<std::size_t>(index)], region.mask.channel};
    }
  }
  for (int y = 0; y < mask.height; ++y) {
    const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(mask.height);
    for (int x = 0; x < mask.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(mask.width);
      for (const Source& source : sources) {
        const float value =
            source.picture == nullptr ? 0.0f : Sample(*source.picture, source.channel, u, v);
        Append(value, 8, &picture);
      }
    }
  }
  return picture;
}

Picture IntegerPicture(const Picture& picture) {
  if (picture.pixels_float.empty()) return picture;
  return {.name = picture.name,
          .width = picture.width,
          .height = picture.height,
          .channels = 4,
          .pixels = render::ToRgba8(picture),
          .pixels16 = {},
          .pixels_float = {}};
}

}  // namespace furrow::authoring
