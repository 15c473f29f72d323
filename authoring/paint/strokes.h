// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/paint/uv_raster.h"
#include "character/character.h"

namespace furrow::character::paint {

// A fold drawn as a line on a surface: a valley with a round ridge on either side, which tapers to
// nothing at both ends.
//
//   height = depth * (ridge * exp(-(2 (x - 1))^2) - exp(-x^2) / (1 + 14 x^2)) * taper(s)
// with x the distance from the line in widths (valley to ridge) and s in [0, 1] the place along it.

// Beyond this many widths from its line a stroke is nothing.
inline constexpr float kStrokeReach = 2.5f;

// A polyline that is asked for its nearest point many times.
class StrokeLine {
 public:
  explicit StrokeLine(std::vector<glm::vec3> points);  // two or more

  struct Nearest {
    float distance = 0.0f;  // metres
    float place = 0.0f;     // along the line, [0, 1]
    glm::vec3 away{0.0f};   // unit, from the line to the point; zero on the line
    glm::vec3 along{0.0f};  // the line's direction there, as long as the piece it is of
  };
  [[nodiscard]] Nearest FindNearest(const glm::vec3& p) const;
  [[nodiscard]] const std::vector<glm::vec3>& points() const { return points_; }
  [[nodiscard]] float length() const { return length_; }

 private:
  std::vector<glm::vec3> points_;
  std::vector<float> places_;
  float length_ = 0.0f;
};

// 0 at both ends of a line, 1 between; `taper`: fraction of the length over which the ends fade,
// (0, 1].
[[nodiscard]] float StrokeTaper(float place, float taper);

// A fold's height in depths and its derivative by the distance in widths. `ridge`: height of the
// ridges as a fraction of the depth, [0, 1].
struct FoldShape {
  float height = 0.0f;
  float slope = 0.0f;
};
[[nodiscard]] FoldShape FoldShapeAt(float widths, float ridge);

// Slopes as a tangent-space normal map of width x height, 16 bits a channel, RGB = n * 0.5 + 0.5,
// green up (glTF), dilated by 16 texels; flat elsewhere. 16 bits, since 8 cannot say 0 and show
// bands on smooth skin; of them `bits` are kept, as RoundNormals() does.
[[nodiscard]] Picture EncodeNormals(const std::vector<Texel>& texels,
                                    std::span<const glm::vec2> slopes, int width, int height,
                                    int bits);

// Rounds a 16-bit normal map to the first `bits` of x and y, [8, 16]: the last ones of a rough
// surface are noise that no PNG packs. z has two fewer, since a slope x / z hardly feels them.
void RoundNormals(int bits, Picture* normals);

// A polyline through `points` by a Catmull-Rom spline, `per_segment` >= 1 pieces each.
[[nodiscard]] std::vector<glm::vec3> Smooth(std::span<const glm::vec3> points, int per_segment);

}  // namespace furrow::character::paint
