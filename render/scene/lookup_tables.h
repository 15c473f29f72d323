// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_objects.h"

namespace furrow::render {

// The tables that shaders look things up in, as textures; made when first used, the same for every
// character and setting.
class LookupTables {
 public:
  // PH of Kelemen and Szirmay-Kalos in R16 (render/skin/beckmann.h).
  [[nodiscard]] GLuint beckmann();
  // What it reflects in all, in RG32F.
  [[nodiscard]] GLuint specular_albedo();
  // Light on a sphere of skin by cosine and curvature, in RGBA16F
  // (render/skin/subsurface_kernel.h).
  [[nodiscard]] GLuint preintegrated();

 private:
  gl::Texture beckmann_;
  gl::Texture specular_albedo_;
  gl::Texture preintegrated_;
};

}  // namespace furrow::render
