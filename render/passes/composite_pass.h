// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

// Turns what a view shows into the 8-bit picture: resolves samples; light gets exposure, tone map
// and sRGB's curve, colours the curve alone, data nothing. Writes the picture's rows from the top,
// as files and encoders have them.
class CompositePass {
 public:
  explicit CompositePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  // `shown`: linear, of `desc`. `bloom`: of AddBloomPass(), or none. Returns the picture.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle shown,
                                       const TextureDesc& desc, const Settings& settings,
                                       FrameGraph::Handle bloom);

 private:
  Fullscreen* fullscreen_;
};

}  // namespace furrow::render
