// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_pass.h"

#include <array>
#include <vector>

namespace furrow::render {
namespace {

constexpr float kNoSurface = 1e6f;  // metres; depth of the background

// Returns true for views that show data. Their background is black.
bool IsData(View view) {
  return view == View::kNormal || view == View::kMaskDynamic || view == View::kMaskTexture;
}

// Clears depth and sets the state that all scene passes share.
void BeginScene(GLuint framebuffer, int width, int height) {
  const float clear_depth = 1.0f;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  // Clearing obeys the depth mask, which fullscreen passes turn off.
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &clear_depth);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glCullFace(GL_BACK);
}

void Clear(GLuint framebuffer, GLint buffer, const std::array<float, 4>& value) {
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, buffer, value.data());
}

}  // namespace

glm::vec3 SkinBackground(const Settings& settings) {
  const bool whole = settings.view == View::kFinal || settings.view == View::kBloom;
  return whole ? settings.background : glm::vec3(0.0f);
}

void ScenePass::AddComposing(FrameGraph* graph, const Settings& settings) {
  if (!scene_->NeedsComposing(settings)) return;
  struct Data {};
  graph->AddPass<Data>(
      // The pass writes textures outside the graph, so it must not be culled.
      "wrinkles", [](FrameGraph::Builder& builder, Data&) { builder.SideEffect(); },
      [this](const FrameGraph::Resources&, const Data&) {
        scene_->Compose();
        return Status();
      });
}

FrameGraph::Handle ScenePass::AddPlain(FrameGraph* graph, const Settings& settings,
                                       const Targets& targets) {
  struct Data {
    FrameGraph::Handle colour;
    FrameGraph::Handle depth;
  };
  AddComposing(graph, settings);
  const Data data = graph->AddPass<Data>(
      "scene",
      [&](FrameGraph::Builder& builder, Data& pass) {
        TextureDesc desc{targets.width, targets.height, targets.format, targets.samples};
        pass.colour = builder.Write(builder.Create("scene colour", desc));
        desc.format = PixelFormat::kDepth32F;
        pass.depth = builder.Write(builder.Create("scene z", desc));
      },
      [this, settings](const FrameGraph::Resources& resources, const Data& pass) {
        const TextureDesc& desc = resources.Desc(pass.colour);
        const GLuint framebuffer =
            device_->Framebuffer(resources.Get(pass.colour), resources.Get(pass.depth));
        BeginScene(framebuffer, desc.width, desc.height);
        const glm::vec3 back = IsData(settings.view) ? glm::vec3(0.0f) : settings.background;
        Clear(framebuffer, 0, {back.r, back.g, back.b, 1.0f});
        return scene_->DrawScene(settings, SceneKind::kPlain);
      });
  return data.colour;
}

SkinTargets ScenePass::AddSkin(FrameGraph* graph, const Settings& settings, const Targets& targets,
                               FrameGraph::Handle shadows) {
  struct Data {
    SkinTargets out;
    FrameGraph::Handle z;
    FrameGraph::Handle shadows;
  };
  const bool has_shadows = shadows.version >= 0;
  AddComposing(graph, settings);
  const Data data = graph->AddPass<Data>(
      "scene",
      [&](FrameGraph::Builder& builder, Data& pass) {
        const auto target = [&](std::string_view name, PixelFormat format) {
          return builder.Write(
              builder.Create(name, {targets.width, targets.height, format, targets.samples}));
        };
        pass.out = {target("scene irradiance", PixelFormat::kRgba16F),
                    target("scene radiance", PixelFormat::kRgba16F),
                    target("scene albedo", PixelFormat::kRgba8),
                    target("scene normal", PixelFormat::kRgba16F),
                    target("scene depth", PixelFormat::kR32F)};
        pass.z = target("scene z", PixelFormat::kDepth32F);
        pass.shadows = shadows;
        if (has_shadows) builder.Read(shadows);
      },
      [this, settings, has_shadows](const FrameGraph::Resources& resources, const Data& pass) {
        const SkinTargets& out = pass.out;
        const std::array<TextureId, 5> colours = {
            resources.Get(out.irradiance), resources.Get(out.radiance), resources.Get(out.albedo),
            resources.Get(out.normal), resources.Get(out.depth)};
        const GLuint framebuffer = device_->Framebuffer(colours, resources.Get(pass.z));
        const TextureDesc& desc = resources.Desc(out.irradiance);
        BeginScene(framebuffer, desc.width, desc.height);
        const glm::vec3 back = SkinBackground(settings);
        // The background has no skin: an infinitely distant point exchanges no light when light
        // scatters.
        Clear(framebuffer, 0, {0.0f, 0.0f, 0.0f, kFarAway});
        Clear(framebuffer, 1, {back.r, back.g, back.b, 0.0f});
        Clear(framebuffer, 2, {0.0f, 0.0f, 0.0f, 0.0f});
        Clear(framebuffer, 3, {0.0f, 0.0f, 0.0f, 0.0f});
        Clear(framebuffer, 4, {kNoSurface, 0.0f, 0.0f, 0.0f});
        scene_->BindTables(has_shadows ? resources.Get(pass.shadows) : 0);
        return scene_->DrawScene(settings, SceneKind::kSkin);
      });
  return data.out;
}

FacetTargets ScenePass::AddFacets(FrameGraph* graph, const Settings& settings, int width,
                                  int height) {
  AddComposing(graph, settings);
  return graph->AddPass<FacetTargets>(
      "scene",
      [&](FrameGraph::Builder& builder, FacetTargets& out) {
        const auto target = [&](std::string_view name, PixelFormat format) {
          return builder.Write(builder.Create(name, {width, height, format, 1}));
        };
        out = {target("scene colour", PixelFormat::kRgba8),
               target("scene normal", PixelFormat::kRgba16F),
               target("scene geometric", PixelFormat::kRgba8),
               target("scene matter", PixelFormat::kRgba8),
               target("scene depth", PixelFormat::kR32F),
               target("scene z", PixelFormat::kDepth32F),
               {},
               {}};
        if (scene_->emits()) out.emission = target("scene emission", PixelFormat::kRgba16F);
        if (scene_->has_motion()) out.motion = target("scene motion", PixelFormat::kRgba16F);
      },
      [this, settings](const FrameGraph::Resources& resources, const FacetTargets& out) {
        std::vector<TextureId> colours = {resources.Get(out.colour), resources.Get(out.normal),
                                          resources.Get(out.geometric), resources.Get(out.matter),
                                          resources.Get(out.depth)};
        for (const FrameGraph::Handle more : {out.emission, out.motion}) {
          if (more.version >= 0) colours.push_back(resources.Get(more));
        }
        const GLuint framebuffer = device_->Framebuffer(colours, resources.Get(out.z));
        const TextureDesc& desc = resources.Desc(out.depth);
        BeginScene(framebuffer, desc.width, desc.height);
        Clear(framebuffer, 4, {kNoSurface, 0.0f, 0.0f, 0.0f});  // the other targets are not read
                                                                // there
        if (out.motion.version >= 0) {
          Clear(framebuffer, static_cast<GLint>(colours.size()) - 1, {0.0f, 0.0f, kFarAway, 0.0f});
        }
        return scene_->DrawScene(settings, SceneKind::kFacets);
      });
}

}  // namespace furrow::render
