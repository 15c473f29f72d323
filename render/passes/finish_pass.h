// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

inline constexpr int kBloomScale = 4;  // picture pixels per bloom pixel, along each axis

// Returns the glow around bright parts of `colour` (linear radiance), at a quarter of its width and
// height; an empty handle if bloom is off. In all functions here, `desc` describes the picture, and
// `fullscreen` or `device` must outlive the graph.
[[nodiscard]] FrameGraph::Handle AddBloomPass(FrameGraph* graph, FrameGraph::Handle colour,
                                              const TextureDesc& desc, const Settings& settings,
                                              Fullscreen* fullscreen);

// How far the glow reaches in a picture of this height, in pixels.
[[nodiscard]] int BloomReach(const Settings& settings, int height);

// How AddShowPass() displays a target.
struct ShowTarget {
  // kColour: rgb unchanged. kMetres: red as a depth, white at near_metres to black at far_metres.
  // kRed: red as grey. kWhite: white, as without a target. kMaps: red as a depth, white at 0 to
  // black at 1; the whole target is shown, centred vertically in the picture.
  enum class Kind { kColour, kMetres, kRed, kWhite, kMaps };
  Kind kind = Kind::kColour;
  float scale = 1.0f;  // picture pixels per texel
  float near_metres = 0.0f;
  float far_metres = 1.0f;
};
// Returns a linear picture that displays `target`, for the views of single stages.
[[nodiscard]] FrameGraph::Handle AddShowPass(FrameGraph* graph, FrameGraph::Handle target,
                                             const ShowTarget& show, const TextureDesc& desc,
                                             Fullscreen* fullscreen);

// Smooths the edges of a finished 8-bit picture with FXAA. Returns the smoothed picture.
[[nodiscard]] FrameGraph::Handle AddFxaaPass(FrameGraph* graph, FrameGraph::Handle picture,
                                             const TextureDesc& desc, Fullscreen* fullscreen);

// Draws small pictures along the right edge of `picture`, from the top, and returns it. `picture`
// and `tiles` are finished pictures, rows from the top. Tiles that do not fit are left out.
[[nodiscard]] FrameGraph::Handle AddStripPass(FrameGraph* graph, FrameGraph::Handle picture,
                                              const std::vector<FrameGraph::Handle>& tiles,
                                              GlDevice* device);

}  // namespace furrow::render
