// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

inline constexpr int kBloomScale = 4;  // picture pixels per bloom pixel, along each axis

// The glow around bright parts, at a quarter of the picture's width and height. Returns no handle
// if bloom is off.
[[nodiscard]] FrameGraph::Handle AddBloomPass(FrameGraph* graph, FrameGraph::Handle colour,
                                              const TextureDesc& desc, const Settings& settings,
                                              Fullscreen* fullscreen);

// How AddShowPass() displays a target.
struct ShowTarget {
  // kMaps shows depths in [0, 1], the whole target, centred vertically in the picture.
  enum class Kind { kColour, kMetres, kRed, kWhite, kMaps };
  Kind kind = Kind::kColour;
  float scale = 1.0f;  // picture pixels per texel
  float near_metres = 0.0f;
  float far_metres = 1.0f;
};
[[nodiscard]] FrameGraph::Handle AddShowPass(FrameGraph* graph, FrameGraph::Handle target,
                                             const ShowTarget& show, const TextureDesc& desc,
                                             Fullscreen* fullscreen);

// Smooths the edges of a finished picture with FXAA.
[[nodiscard]] FrameGraph::Handle AddFxaaPass(FrameGraph* graph, FrameGraph::Handle picture,
                                             const TextureDesc& desc, Fullscreen* fullscreen);

// Draws small pictures along the right edge of a picture, from the top. `picture` and `tiles` are
// finished pictures, rows from the top. All tiles have the same size.
[[nodiscard]] FrameGraph::Handle AddStripPass(FrameGraph* graph, FrameGraph::Handle picture,
                                              const std::vector<FrameGraph::Handle>& tiles,
                                              GlDevice* device);

}  // namespace furrow::render
