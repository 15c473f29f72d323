// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <glm/vec4.hpp>

#include "render/gl/egl_context.h"
#include "render/passes/scene_pass.h"

namespace furrow::render::test {

// Draws the scene pass only and returns its output as 32-bit floats, for comparisons that 8 bits
// are too coarse for.
class SceneProbe {
 public:
  explicit SceneProbe(const character::Character& character);

  // Returns width * height pixels, rows from the bottom, as in OpenGL.
  [[nodiscard]] std::vector<glm::vec4> Draw(const FrameRequest& request);
  [[nodiscard]] const WrinkleTables& tables() const { return *tables_; }

 private:
  const character::Character& character_;
  std::unique_ptr<EglContext> context_;
  GlDevice device_;
  TransientPool pool_{&device_};
  ShaderLibrary shaders_;
  std::unique_ptr<GpuCharacter> gpu_;
  std::unique_ptr<WrinkleTables> tables_;
  std::unique_ptr<SceneDraw> scene_;
  std::unique_ptr<ScenePass> pass_;
};

}  // namespace furrow::render::test
