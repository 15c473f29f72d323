// SPDX-License-Identifier: Apache-2.0
#include "render/passes/composite_pass.h"

namespace furrow::render {
namespace {

enum UniformLocation : GLint { kExposure = 0, kHeight = 1, kBloom = 2 };

// SHOW of composite.frag.glsl.
enum class Show { kData, kColour, kLight };

Show ShowOf(View view) {
  switch (view) {
    case View::kNormal:
    case View::kMaskDynamic:
    case View::kMaskTexture:
    case View::kShadow:
    case View::kDepth:
    case View::kMaterial:
    case View::kOcclusion: return Show::kData;
    case View::kAlbedo: return Show::kColour;
    default: return Show::kLight;
  }
}

std::string Define(std::string_view name, int value) {
  return std::string(name) + " " + std::to_string(value);
}

}  // namespace

FrameGraph::Handle CompositePass::Add(FrameGraph* graph, FrameGraph::Handle shown,
                                      const TextureDesc& desc, const Settings& settings,
                                      FrameGraph::Handle bloom) {
  struct Data {
    FrameGraph::Handle shown;
    FrameGraph::Handle bloom;
    FrameGraph::Handle picture;
  };
  const bool blooms = bloom.version >= 0;
  const std::vector<std::string> defines = {
      Define("SAMPLES", desc.samples), Define("SHOW", static_cast<int>(ShowOf(settings.view))),
      Define("TONE_MAP", static_cast<int>(settings.tone_map)), Define("BLOOM", blooms)};
  const Data data = graph->AddPass<Data>(
      "composite",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass = {shown, bloom, {}};
        builder.Read(shown);
        if (blooms) builder.Read(bloom);
        pass.picture = builder.Write(
            builder.Create("picture", {desc.width, desc.height, PixelFormat::kRgba8, 1}));
      },
      [this, defines, exposure = settings.exposure, bloom_strength = settings.bloom.strength,
       blooms](const FrameGraph::Resources& resources, const Data& pass) {
        Status status = fullscreen_->Begin("composite.frag.glsl", defines, resources,
                                           {pass.picture}, {pass.shown, pass.bloom});
        if (!status.ok()) return status;
        glUniform1f(kExposure, exposure);
        glUniform1i(kHeight, resources.Desc(pass.picture).height);
        if (blooms) glUniform1f(kBloom, bloom_strength);
        fullscreen_->Draw();
        return status;
      });
  return data.picture;
}

}  // namespace furrow::render
