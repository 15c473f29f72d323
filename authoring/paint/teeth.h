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

// Centimetres. x: the subject's left; y: up; z: forward.
struct ToothArch {
  bool upper = true;
  glm::vec3 front{0.0f};  // the middle of the biting edge
  float half_width = 2.75f;
  float half_depth = 4.2f;
  float rise = 0.0f;  // height of the molars' edge above the front
};

struct ToothRow {
  std::vector<glm::vec3> positions;  // centimetres
  std::vector<glm::vec2>
      uvs;  // one per position; the upper row is in the upper half of the picture
  std::vector<std::uint32_t> quads;  // four indices per quad, counter-clockwise from the front
};

[[nodiscard]] ToothRow MakeToothRow(const ToothArch& arch);

// 8-bit sRGB. `age`, [0, 1]: yellower teeth and receding gums.
[[nodiscard]] character::Picture PaintTeeth(float age, int size);

}  // namespace furrow::authoring
