// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// Draws the shadow maps: the lamps' depth pictures, side by side in one texture of kNumLights
// squares. They are kept from frame to frame and redrawn only when a lamp or a surface that casts
// shadows has moved. Changing other settings while a pose is held does not redraw them.
class ShadowPass {
 public:
  // Both arguments must outlive the pass.
  ShadowPass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}
  ~ShadowPass();
  ShadowPass(const ShadowPass&) = delete;
  ShadowPass& operator=(const ShadowPass&) = delete;

  // Returns the texture of all maps. Linear depth: 0 is nearest to the lamp, 1 is empty. Only the
  // first ShadowSettings::lamps maps are drawn; the others are empty.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, const FrameRequest& request);

 private:
  // All values that the maps depend on.
  [[nodiscard]] std::vector<float> Inputs(const FrameRequest& request) const;
  [[nodiscard]] Status Draw(const Settings& settings, TextureId maps);

  SceneDraw* scene_;
  GlDevice* device_;
  TextureDesc desc_;
  TextureId maps_ = 0;
  std::vector<float> drawn_;  // Inputs() of the current maps; empty: no maps yet
};

}  // namespace furrow::render
