// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

// Converts the result of a view to the 8-bit picture. Resolves samples. Light gets exposure, tone
// map and the sRGB curve; colours get the sRGB curve only; data stays unchanged. Writes rows from
// the top, as files and encoders expect.
class CompositePass {
 public:
  explicit CompositePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  // `shown`: linear, as `desc` describes it. `bloom`: the result of AddBloomPass(), or none.
  // Returns the picture.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle shown,
                                       const TextureDesc& desc, const Settings& settings,
                                       FrameGraph::Handle bloom);

 private:
  Fullscreen* fullscreen_;
};

}  // namespace furrow::render
