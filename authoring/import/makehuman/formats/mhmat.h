// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "base/status.h"

namespace furrow::authoring {

// The parts of MakeHuman's .mhmat file that are drawn. Paths are as in the file, with forward
// slashes; empty: none.
struct MhMaterial {
  std::string name;
  glm::vec3 colour{1.0f};  // sRGB in [0, 1]; multiplies the picture
  std::string colour_picture;
  std::string normal_picture;
  bool transparent = false;   // the alpha of the picture matters
  bool double_sided = false;  // back faces are drawn
};

// Parses a .mhmat file. `source`: the file name in errors. Unknown lines are skipped: MakeHuman's
// files set many properties of its own shaders.
//
// Errors name "source:line": kParse (a colour without three numbers), kNonFinite, kSchema (the
// file has no line of a material), kUnsupported (a Git LFS pointer).
[[nodiscard]] Result<MhMaterial> ParseMhmat(std::string_view text, std::string_view source);

}  // namespace furrow::authoring
