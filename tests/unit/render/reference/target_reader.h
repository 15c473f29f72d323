// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "render/graph/frame_graph.h"
#include "render/renderer.h"
#include "tests/unit/render/reference/float_picture.h"

namespace furrow::render::test {

// Reads the targets that a frame's passes write, as floats; install it with
// Renderer::SetObserver(). It does not read multisampled targets, so request one sample
// (Settings::anti_aliasing).
class TargetReader final : public FrameGraphObserver {
 public:
  void BeforePass(std::string_view) override {}
  void AfterPass(std::string_view pass, const std::vector<Written>& written) override;

  // The texture as its last pass left it. Throws std::out_of_range, which fails the test, if no
  // pass wrote it.
  [[nodiscard]] const FloatPicture& Target(const std::string& name) const;
  [[nodiscard]] bool Has(const std::string& name) const { return targets_.count(name) != 0; }

 private:
  std::map<std::string, FloatPicture> targets_;
};

// Draws one frame of a character and returns one target. Aborts if OpenGL is unavailable.
[[nodiscard]] FloatPicture DrawTarget(const character::Character& character,
                                      const FrameRequest& request, const std::string& target);

}  // namespace furrow::render::test
