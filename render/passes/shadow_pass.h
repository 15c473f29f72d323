// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// The lamps' depth pictures, side by side in one texture of kNumLights squares. They are kept, and
// drawn anew only when a lamp, or anybody who casts a shadow, has moved: not while a pose is held
// and its looks are changed.
class ShadowPass {
 public:
  // Both outlive the pass.
  ShadowPass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}
  ~ShadowPass();
  ShadowPass(const ShadowPass&) = delete;
  ShadowPass& operator=(const ShadowPass&) = delete;

  // Those of the first ShadowSettings::lamps; the others are empty: nothing casts there.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, const FrameRequest& request);

 private:
  // All that the maps depend on.
  [[nodiscard]] std::vector<float> Inputs(const FrameRequest& request) const;
  [[nodiscard]] Status Draw(const Settings& settings, TextureId maps);

  SceneDraw* scene_;
  GlDevice* device_;
  TextureDesc desc_;
  TextureId maps_ = 0;
  std::vector<float> drawn_;  // Inputs() of what the maps hold; empty: of nothing
};

}  // namespace furrow::render
