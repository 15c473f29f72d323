// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/frame_graph.h"
#include "render/gl_device.h"
#include "render/scene_draw.h"

namespace furrow::render {

// The lamps' depth pictures, side by side in one texture of kNumLights squares.
class ShadowPass {
 public:
  ShadowPass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}

  // Draws those of the first ShadowSettings::lamps; the others stay empty: nothing casts there.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, const Settings& settings);

 private:
  SceneDraw* scene_;
  GlDevice* device_;
};

}  // namespace furrow::render
