// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/layers/blood.h"
#include "authoring/paint/canvas.h"
#include "base/srgb.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

character::Picture Sized(const BakedMap& map, std::string name, int channels) {
  character::Picture picture;
  picture.name = std::move(name);
  picture.width = map.width;
  picture.height = map.height;
  picture.channels = channels;
  return picture;
}

std::uint16_t Unsigned16(float value) {
  return static_cast<std::uint16_t>(std::lround(65535.0f * std::clamp(value, 0.0f, 1.0f)));
}

// Texel t stands for (2 t - 1) * scale; see wrinkle::WrinkleMap.
std::uint16_t Signed16(float value, float scale) { return Unsigned16(0.5f + 0.5f * value / scale); }

std::vector<float> HalvedPlane(const std::vector<float>& plane, int width, int height,
                               int channels) {
  std::vector<float> half;
  half.reserve(plane.size() / 4);
  const auto at = [&](int x, int y, int c) {
    const auto texel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    return plane[texel * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
  };
  for (int y = 0; y + 1 < height; y += 2) {
    for (int x = 0; x + 1 < width; x += 2) {
      for (int c = 0; c < channels; ++c) {
        half.push_back(0.25f *
                       (at(x, y, c) + at(x + 1, y, c) + at(x, y + 1, c) + at(x + 1, y + 1, c)));
      }
    }
  }
  return half;
}

// A height above the rig's limit would be cut off without notice.
Status CheckHeights(const BakedMap& map, float height_mm) {
  float most = 0.0f;
  for (const float mm : map.height_mm) most = std::max(most, std::abs(mm));
  if (most <= height_mm) return {};
  char text[96];
  std::snprintf(text, sizeof text, "folds are %.2f mm high; the rig allows at most %.2f mm",
                static_cast<double>(most), static_cast<double>(height_mm));
  return {StatusCode::kInvalidArgument, text, "map '" + map.map + "'",
          "increase the wrinkle map's height_mm"};
}

}  // namespace

character::Picture NormalPicture(const BakedMap& map, std::string name) {
  character::Picture picture = Sized(map, std::move(name), 3);
  picture.pixels16.reserve(map.derivative.size() / 2 * 3);
  for (std::size_t i = 0; i + 1 < map.derivative.size(); i += 2) {
    const glm::vec3 n = glm::normalize(glm::vec3(map.derivative[i], map.derivative[i + 1], 1.0f));
    for (int c = 0; c < 3; ++c) picture.pixels16.push_back(Unsigned16(n[c] * 0.5f + 0.5f));
  }
  return picture;
}

character::Picture DerivativePicture(const BakedMap& map, float scale, std::string name) {
  // PNG has no two-channel format that every reader takes for red and green, so blue is 0.
  character::Picture picture = Sized(map, std::move(name), 3);
  picture.pixels16.reserve(map.derivative.size() / 2 * 3);
  for (std::size_t i = 0; i + 1 < map.derivative.size(); i += 2) {
    picture.pixels16.push_back(Signed16(map.derivative[i], scale));
    picture.pixels16.push_back(Signed16(map.derivative[i + 1], scale));
    picture.pixels16.push_back(0);
  }
  return picture;
}

character::Picture HeightPicture(const BakedMap& map, float height_mm, std::string name) {
  character::Picture picture = Sized(map, std::move(name), 1);
  picture.pixels16.reserve(map.height_mm.size());
  for (const float mm : map.height_mm) picture.pixels16.push_back(Signed16(mm, height_mm));
  return picture;
}

character::Picture FloatPicture(const BakedMap& map, const std::vector<float>& plane,
                                std::string name) {
  const auto texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  character::Picture picture = Sized(map, std::move(name), static_cast<int>(plane.size() / texels));
  picture.pixels_float = plane;
  return picture;
}

character::Picture CavityPicture(const BakedMap& map, std::string name) {
  character::Picture picture = Sized(map, std::move(name), 1);
  picture.pixels.reserve(map.cavity.size());
  for (const float open : map.cavity) picture.pixels.push_back(ToByte(open));
  return picture;
}

character::Picture ColourPicture(const BakedMap& map, float scale, std::string name) {
  character::Picture picture = Sized(map, std::move(name), 3);
  picture.pixels.reserve(3 * map.blood.size());
  for (const float blood : map.blood) {
    const glm::vec3 tint = BloodTint(blood) / scale;
    for (int c = 0; c < 3; ++c) picture.pixels.push_back(ToByte(SrgbFromLinear(tint[c])));
  }
  return picture;
}

BakedMap Halved(const BakedMap& map) {
  BakedMap half;
  half.map = map.map;
  half.cloth = map.cloth;
  half.width = map.width / 2;
  half.height = map.height / 2;
  half.height_mm = HalvedPlane(map.height_mm, map.width, map.height, 1);
  half.derivative = HalvedPlane(map.derivative, map.width, map.height, 2);
  half.cavity = HalvedPlane(map.cavity, map.width, map.height, 1);
  half.blood = HalvedPlane(map.blood, map.width, map.height, 1);
  return half;
}

Result<std::vector<character::Picture>> WrinkleMapPictures(const BakedMap& baked,
                                                           const wrinkle::WrinkleMap& map) {
  std::vector<character::Picture> pictures;
  if (!map.normal.empty()) pictures.push_back(NormalPicture(baked, map.normal));
  const bool halves = baked.width % 2 == 0 && baked.width / 2 >= kSmallestHalf;
  const BakedMap small = halves ? Halved(baked) : baked;
  if (!map.height.empty()) {
    FURROW_RETURN_IF_ERROR(CheckHeights(small, map.height_mm));
    pictures.push_back(HeightPicture(small, map.height_mm, map.height));
  }
  if (!map.cavity.empty()) pictures.push_back(CavityPicture(small, map.cavity));
  if (!map.colour.empty()) {
    pictures.push_back(ColourPicture(small, map.colour_scale, map.colour));
  }
  return pictures;
}

}  // namespace furrow::authoring
