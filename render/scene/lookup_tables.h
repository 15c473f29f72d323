// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_objects.h"

namespace furrow::render {

// Look-up tables of the shaders as textures, created on first use and owned by this object. They do
// not depend on the character or on settings. Needs a current context.
class LookupTables {
 public:
  // The Beckmann term PH of Kelemen and Szirmay-Kalos, R16 (render/skin/beckmann.h).
  [[nodiscard]] GLuint beckmann();
  // Albedo of both specular lobes, RGBA32F (TwoLobeAlbedoTable() of render/skin/beckmann.h).
  [[nodiscard]] GLuint specular_albedo();
  // Light on a sphere of skin by cosine and curvature, RGBA16F (PreintegratedTable() of
  // render/skin/subsurface_kernel.h).
  [[nodiscard]] GLuint preintegrated();

 private:
  gl::Texture beckmann_;
  gl::Texture specular_albedo_;
  gl::Texture preintegrated_;
};

}  // namespace furrow::render
