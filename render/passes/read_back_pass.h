// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_device.h"
#include "render/gl/read_back.h"
#include "render/graph/frame_graph.h"

namespace furrow::render {

// Adds a pass that starts the copy of `picture` (8-bit RGBA) to memory: ReadBack::Start() with
// `label`. This side effect keeps the passes before it from being culled. `device` and `read_back`
// must outlive the graph.
void AddReadBackPass(FrameGraph* graph, FrameGraph::Handle picture, const ReadBack::Label& label,
                     GlDevice* device, ReadBack* read_back);

}  // namespace furrow::render
