// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// The output of a bake.
namespace furrow::authoring {

// A suggestion for the mask of a region: where the poses of the region make folds.
struct BakedMask {
  std::string region;
  int width = 0;  // a quarter of the map's size, since masks are soft
  int height = 0;
  std::vector<float> texels;  // rows from the top, [0, 1]
};

// One wrinkle map in the UV atlas of its surface. All planes store rows from the top.
struct BakedMap {
  std::string map;
  bool cloth = false;  // true: drawn on cloth; false: on skin
  int width = 0;
  int height = 0;
  std::vector<float> height_mm;   // above the rest surface; ridges are positive
  std::vector<float> derivative;  // two per texel: n.xy / n.z = -dh/d(tangent), -dh/d(bitangent).
                                  // The bitangent points up the picture (glTF's green channel).
  std::vector<float> cavity;      // how open a valley is to the sky, [0, 1]; 1 on flat surface
  std::vector<float> blood;       // 1 plus the blood that is added, or missing, per area, relative
                                  // to the mean skin of a face: 1 at rest, more if compressed
  std::vector<std::uint8_t> covered;  // 1 under a triangle; other texels hold dilated values
  std::vector<BakedMask> masks;       // one per region with poses that feed the map

  // The index of a texel in a plane; column `x`, row `y` from the top.
  [[nodiscard]] std::size_t IndexOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }

  struct Statistics {
    std::int64_t covered_texels = 0;
    std::int64_t folded_texels = 0;       // covered texels more than 0.01 mm high or deep
    float worst_compression = 0.0f;       // of any triangle, before the limit and averaging, [0, 1)
    float mean_compression = 0.0f;        // over the folded area, after averaging
    float deepest_mm = 0.0f;              // deepest valley, >= 0
    float highest_mm = 0.0f;              // highest ridge, >= 0
    float steepest = 0.0f;                // length of the largest derivative
    float texel_mm = 0.0f;                // mean texel size on the surface where it folds
    int strokes = 0;                      // fold strokes that cover at least one texel
    std::int64_t overlapping_texels = 0;  // inside several triangles; the first triangle is used
    float finest_mm = 0.0f;               // requested wavelengths where the surface folds
    float coarsest_mm = 0.0f;
    std::int64_t widened_texels = 0;  // folded texels with a requested wavelength below the limit
    float widened_from_mm = 0.0f;     // the wavelength that was widened most ...
    float widened_to_mm = 0.0f;       // ... and the result
  } statistics;
};

// All maps of a bake.
struct BakedMaps {
  // In the order of Character::rig.wrinkle_maps, without maps that have no pose and no stroke.
  std::vector<BakedMap> maps;
};

}  // namespace furrow::authoring
