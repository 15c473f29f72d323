// SPDX-License-Identifier: Apache-2.0
#include "render/passes/composite_pass.h"

#include "render/gl/shader_program.h"

namespace furrow::render {
namespace {

enum UniformLocation : GLint { kExposure = 0, kHeight = 1, kBloom = 2 };

// SHOW of post/composite.frag.glsl.
enum class Show { kData, kColour, kLight };

Show ShowOf(View view) {
  switch (view) {
    case View::kNormal:
    case View::kMaskDynamic:
    case View::kMaskTexture:
    case View::kShadow:
    case View::kShadowMaps:
    case View::kDepth:
    case View::kMaterial:
    case View::kOcclusion: return Show::kData;
    case View::kAlbedo: return Show::kColour;
    default: return Show::kLight;
  }
}

}  // namespace

FrameGraph::Handle CompositePass::Add(FrameGraph* graph, FrameGraph::Handle shown,
                                      const TextureDesc& desc, const Settings& settings,
                                      FrameGraph::Handle bloom) {
  const bool blooms = bloom.version >= 0;
  return fullscreen_->AddSimplePass(
      graph,
      {.name = "composite",
       .fragment = "post/composite.frag.glsl",
       .defines = {Define("SAMPLES", desc.samples),
                   Define("SHOW", static_cast<int>(ShowOf(settings.view))),
                   Define("TONE_MAP", static_cast<int>(settings.tone_map)), Define("BLOOM", blooms),
                   Define("BOTTOM_UP", false)},
       .reads = {shown, bloom},
       .writes = {{"picture", {desc.width, desc.height, PixelFormat::kRgba8, 1}}}},
      [this, exposure = settings.exposure, strength = settings.bloom.strength, blooms,
       height = desc.height] {
        glUniform1f(kExposure, exposure);
        glUniform1i(kHeight, height);
        if (blooms) glUniform1f(kBloom, strength);
        fullscreen_->Draw();
      });
}

}  // namespace furrow::render
