// SPDX-License-Identifier: Apache-2.0
#include "render/passes/read_back_pass.h"

namespace furrow::render {

void AddReadBackPass(FrameGraph* graph, FrameGraph::Handle picture, const ReadBack::Label& label,
                     GlDevice* device, ReadBack* read_back) {
  struct Data {
    FrameGraph::Handle picture;
  };
  graph->AddPass<Data>(
      "read back",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass.picture = picture;
        builder.Read(picture);
        builder.SideEffect();
      },
      [=](const FrameGraph::Resources& resources, const Data& pass) {
        const TextureDesc& desc = resources.Desc(pass.picture);
        read_back->Start(device->Framebuffer(resources.Get(pass.picture), 0), desc.width,
                         desc.height, label);
        return Status();
      });
}

}  // namespace furrow::render
