// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// Folds along lines ("strokes"): a valley with a round ridge on either side, which fades at both
// ends. The height is
//
//   depth * (ridge * exp(-(2 (x - 1))^2) - exp(-x^2) / (1 + 14 x^2)) * taper(s)
//
// x is the distance from the line in widths (valley to ridge), s in [0, 1] the position along the
// line.

// A stroke has no effect beyond this many widths from its line.
inline constexpr float kStrokeReach = 2.5f;

// A polyline that finds its nearest point to a position. Metres.
class StrokeLine {
 public:
  explicit StrokeLine(std::vector<glm::vec3> points);  // at least two points

  struct Nearest {
    float distance = 0.0f;  // metres
    float place = 0.0f;     // position along the line, 0 start to 1 end
    glm::vec3 away{0.0f};   // unit vector from the line to the point; zero on the line
    glm::vec3 along{0.0f};  // the nearest segment, from its start to its end
  };
  [[nodiscard]] Nearest FindNearest(const glm::vec3& p) const;
  [[nodiscard]] const std::vector<glm::vec3>& points() const { return points_; }
  [[nodiscard]] float length() const { return length_; }

 private:
  std::vector<glm::vec3> points_;
  std::vector<float> places_;
  float length_ = 0.0f;
};

// The strength of a fold at `place`, [0, 1] along its line: 0 at both ends, 1 between them.
// `taper`: fraction of the length over which the ends fade, (0, 1].
[[nodiscard]] float StrokeTaper(float place, float taper);

// The cross-section of a fold at one distance from its line.
struct FoldShape {
  float height = 0.0f;  // as a fraction of the depth; about -1 at the line
  float slope = 0.0f;   // derivative of `height` by the distance in widths
};
// `widths`: distance from the line, in widths, >= 0. `ridge`: height of the ridges as a fraction of
// the depth, [0, 1].
[[nodiscard]] FoldShape FoldShapeAt(float widths, float ridge);

// Encodes slopes as a tangent-space normal map of `width` x `height` texels: 16 bits per channel,
// RGB = n * 0.5 + 0.5, green up (glTF), dilated by kSeamTexels, flat elsewhere. `slopes`: one per
// texel of `texels`, dh/d(tangent) and dh/d(bitangent). 8 bits could not represent 0 and would show
// bands on smooth skin. `bits`: see RoundNormals().
[[nodiscard]] character::Picture EncodeNormals(const std::vector<SurfaceTexel>& texels,
                                               std::span<const glm::vec2> slopes, int width,
                                               int height, int bits);

// A component of a unit normal as a texel of such a map, and back.
[[nodiscard]] std::uint16_t NormalTexel(float component);
[[nodiscard]] float NormalComponent(std::uint16_t texel);

// Rounds a 16-bit normal map to the first `bits` bits of x and y, [8, 16]. The last bits of a rough
// surface are noise that PNG cannot compress. z keeps two bits fewer, since the slope x / z depends
// little on it.
void RoundNormals(int bits, character::Picture* normals);

// A Catmull-Rom spline through `points` as a polyline, with `per_segment` >= 1 pieces per segment.
[[nodiscard]] std::vector<glm::vec3> Smooth(std::span<const glm::vec3> points, int per_segment);

}  // namespace furrow::authoring
