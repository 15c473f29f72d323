// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "render/graph/frame_graph.h"
#include "render/renderer.h"
#include "tests/unit/render/reference/float_picture.h"

namespace furrow::render::test {

// Reads what a frame's passes leave in their targets, in floats: Renderer::SetObserver(). Targets
// with several samples are not read: ask for one (Settings::anti_aliasing).
class TargetReader final : public FrameGraphObserver {
 public:
  void BeforePass(std::string_view) override {}
  void AfterPass(std::string_view pass, const std::vector<Written>& written) override;

  // As the last pass that wrote the texture left it. Throws std::out_of_range, which fails the
  // test, when nobody did.
  [[nodiscard]] const FloatPicture& Target(const std::string& name) const;
  [[nodiscard]] bool Has(const std::string& name) const { return targets_.count(name) != 0; }

 private:
  std::map<std::string, FloatPicture> targets_;
};

// What one frame of a character leaves in one target. Aborts where there is no OpenGL.
[[nodiscard]] FloatPicture DrawTarget(const character::Character& character,
                                      const FrameRequest& request, const std::string& target);

}  // namespace furrow::render::test
