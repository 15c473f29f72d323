// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

// Teeth of generated and imported characters: rows of crowns with gums on an elliptic arch,
// modelled from the front only, and the picture that both rows share.
namespace furrow::authoring {

// The ellipse that a row of teeth follows, in centimetres. x: the subject's left; y: up; z:
// forward.
struct ToothArch {
  bool upper = true;
  glm::vec3 front{0.0f};     // the middle of the biting edge
  float half_width = 2.75f;  // half axis of the ellipse along x
  float half_depth = 4.2f;   // half axis of the ellipse along z
  float rise = 0.0f;         // height of the molars' edge above the front
};

// The mesh of a row of teeth with its gums.
struct ToothRow {
  std::vector<glm::vec3> positions;  // centimetres
  // One per position, v down. The upper row uses the upper half of the picture, the lower row the
  // lower half.
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> quads;  // four indices per quad, counter-clockwise from the front
};

// Makes the row of teeth along `arch`.
[[nodiscard]] ToothRow MakeToothRow(const ToothArch& arch);

// Paints the picture of both rows, 8-bit sRGB. `age`: 0 young (white teeth) to 1 old (yellow teeth,
// receding gums). `size`: width and height, texels.
[[nodiscard]] character::Picture PaintTeeth(float age, int size);

}  // namespace furrow::authoring
