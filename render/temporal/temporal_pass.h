// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/mesh/screen_rect.h"
#include "render/passes/fullscreen.h"
#include "render/temporal/history.h"

namespace furrow::render {

// The drawn picture of a stream.
struct DrawnPicture {
  FrameGraph::Handle picture;  // finished, rows from the top
  FrameGraph::Handle depth;    // metres along the camera's axis
  FrameGraph::Handle motion;   // FacetTargets::motion
  ScreenRect bounds;           // of the subject, drawn pixels; rows from the bottom
  float focus_distance = 1.0f;
};

// Completes a drawn picture from the former pictures of its stream (shaders/temporal/), and keeps
// what the next one needs in the textures of `frame`. Returns the picture, `whole` pixels. Pixels
// farther than `glow` pixels from the bounds show the even background. `frame` and `fullscreen`
// must outlive the graph.
[[nodiscard]] FrameGraph::Handle AddTemporalPasses(FrameGraph* graph, const TemporalFrame& frame,
                                                   const DrawnPicture& drawn,
                                                   const TextureDesc& whole, int glow,
                                                   Fullscreen* fullscreen);

}  // namespace furrow::render
