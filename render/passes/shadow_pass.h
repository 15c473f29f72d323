// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// Draws the shadow maps: the lamps' depth pictures, side by side in one texture of kNumLights
// squares. They are kept from frame to frame and redrawn only when a lamp or a surface that casts
// shadows has moved. Changing other settings while a pose is held does not redraw them. A stream
// has maps of its own, which every second picture draws.
class ShadowPass {
 public:
  // Both arguments must outlive the pass.
  ShadowPass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}
  ~ShadowPass();
  ShadowPass(const ShadowPass&) = delete;
  ShadowPass& operator=(const ShadowPass&) = delete;

  // Returns the texture of all maps. Linear depth: 0 is nearest to the lamp, 1 is empty. Only the
  // first ShadowSettings::lamps maps are drawn; the others are empty.
  // For a picture of a stream, `kept` are the stream's maps, which must outlive the graph. They are
  // used as the former picture left them if the scene is drawn with its shadows
  // (SceneDraw::shadow_camera()). Null: the picture stands alone.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, const FrameRequest& request,
                                       KeptShadows* kept);

 private:
  // All values that the maps depend on.
  [[nodiscard]] std::vector<float> Inputs(const FrameRequest& request) const;
  [[nodiscard]] FrameGraph::Handle AddForStream(FrameGraph* graph, const Settings& settings,
                                                KeptShadows* kept, bool keeps);
  // Adds the pass that draws `maps`. `finished` learns whether it succeeded, if the pass runs.
  [[nodiscard]] FrameGraph::Handle AddDrawing(FrameGraph* graph, FrameGraph::Handle maps,
                                              const Settings& settings,
                                              std::function<void(bool)> finished);
  [[nodiscard]] TextureDesc Wanted() const;
  [[nodiscard]] Status Draw(const Settings& settings, TextureId maps);

  SceneDraw* scene_;
  GlDevice* device_;
  KeptTexture maps_;          // of pictures without maps of their own
  std::vector<float> drawn_;  // Inputs() of the current maps; empty: no maps yet
};

}  // namespace furrow::render
