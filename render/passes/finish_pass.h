// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"

namespace furrow::render {

inline constexpr int kBloomScale = 4;  // pixels of the picture to one of the bloom's, each axis

// Light that a lens spreads, a quarter as large as the picture; none where it is off.
[[nodiscard]] FrameGraph::Handle AddBloomPass(FrameGraph* graph, FrameGraph::Handle colour,
                                              const TextureDesc& desc, const Settings& settings,
                                              Fullscreen* fullscreen);

// How a target is made visible.
struct ShowTarget {
  // kMaps: depths in [0, 1], all of the target in the middle of the picture.
  enum class Kind { kColour, kMetres, kRed, kWhite, kMaps };
  Kind kind = Kind::kColour;
  float scale = 1.0f;  // pixels of the picture to one texel
  float near_metres = 0.0f;
  float far_metres = 1.0f;
};
[[nodiscard]] FrameGraph::Handle AddShowPass(FrameGraph* graph, FrameGraph::Handle target,
                                             const ShowTarget& show, const TextureDesc& desc,
                                             Fullscreen* fullscreen);

// Smooths the edges of a finished picture.
[[nodiscard]] FrameGraph::Handle AddFxaaPass(FrameGraph* graph, FrameGraph::Handle picture,
                                             const TextureDesc& desc, Fullscreen* fullscreen);

// Puts small pictures on a picture's right-hand side, from the top. `picture` and `tiles` are
// finished pictures, rows from the top; the tiles are of one size.
[[nodiscard]] FrameGraph::Handle AddStripPass(FrameGraph* graph, FrameGraph::Handle picture,
                                              const std::vector<FrameGraph::Handle>& tiles,
                                              GlDevice* device);

}  // namespace furrow::render
