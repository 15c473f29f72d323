// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_device.h"
#include "render/gl/read_back.h"
#include "render/graph/frame_graph.h"

namespace furrow::render {

// Starts the copy of the picture to memory. This is the side effect that keeps the passes before it
// from being culled.
void AddReadBackPass(FrameGraph* graph, FrameGraph::Handle picture, std::uint64_t token,
                     GlDevice* device, ReadBack* read_back);

}  // namespace furrow::render
