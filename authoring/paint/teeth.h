// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"

// Teeth as characters that are made here wear them: a row of crowns with gums on an elliptic arch,
// seen from the front alone, and the picture that both rows share.
namespace furrow::character::paint {

// Centimetres; x to the subject's left, y up, z forward.
struct ToothArch {
  bool upper = true;
  glm::vec3 front{0.0f};  // the middle of the biting edge
  float half_width = 2.75f;
  float half_depth = 4.2f;
  float rise = 0.0f;  // of the edge from the front to the molars
};

struct ToothRow {
  std::vector<glm::vec3> positions;  // centimetres
  std::vector<glm::vec2> uvs;        // one a position: the upper row above, the lower one below
  std::vector<std::uint32_t> quads;  // four a quad, counter-clockwise from in front
};

[[nodiscard]] ToothRow MakeToothRow(const ToothArch& arch);

// 8-bit sRGB. `age` in [0, 1]: yellower, receding gums.
[[nodiscard]] Picture PaintTeeth(float age, int size);

}  // namespace furrow::character::paint
