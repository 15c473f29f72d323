// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

// Converts the result of a view to the 8-bit picture: averages the samples of each pixel and
// encodes the values. Views of light get exposure, tone map and the sRGB curve; views of colours
// get the sRGB curve only; views of data stay unchanged. Writes rows from the top, as files and
// encoders expect.
class CompositePass {
 public:
  // `fullscreen` must outlive the pass.
  explicit CompositePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  // Returns the 8-bit picture of settings.view. `shown`: linear values; `desc` describes it.
  // `bloom`: the result of AddBloomPass(), or an empty handle.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle shown,
                                       const TextureDesc& desc, const Settings& settings,
                                       FrameGraph::Handle bloom);

 private:
  Fullscreen* fullscreen_;
};

}  // namespace furrow::render
