// SPDX-License-Identifier: Apache-2.0
#include "render/pipeline.h"

#include <algorithm>

#include "render/passes/finish_pass.h"
#include "render/passes/light_pass.h"
#include "render/passes/resolve_pass.h"
#include "render/temporal/temporal_pass.h"

namespace furrow::render {
namespace {

using Handle = FrameGraph::Handle;

// SubsurfaceSettings::taps, if FrameRequest::is_moving.
constexpr int kMovingTaps = 11;

// Returns true for views of one part of the light. They show it before occlusion.
bool IsPartOfLight(View view) {
  return view == View::kShadow || view == View::kSpecular || view == View::kTranslucency ||
         view == View::kAlbedo || view == View::kMaterial;
}

// Returns true for views that show light. FXAA would corrupt the other views' data.
bool IsLight(View view) {
  return view == View::kFinal || view == View::kWeights || view == View::kWireframe;
}

// Resolves the automatic number of samples. `affordable`: multisampling is cheap enough for this
// view on this device.
AntiAliasingSettings Chosen(const AntiAliasingSettings& asked, bool affordable) {
  if (asked.samples != 0) return asked;
  return affordable ? AntiAliasingSettings{4, asked.fxaa} : AntiAliasingSettings{1, true};
}

}  // namespace

Pipeline::Pipeline(const character::Character& character, SceneDraw* scene, ShaderLibrary* shaders,
                   GlDevice* device, bool is_software)
    : scene_(scene),
      is_software_(is_software),
      skin_bounds_(character,
                   [](const character::Material& material) {
                     return material.kind == character::Material::Kind::kSkin;
                   }),
      bounds_(character, [](const character::Material&) { return true; }),
      fullscreen_(shaders, device),
      shadow_pass_(scene, device),
      scene_pass_(scene, device),
      occlusion_pass_(&fullscreen_),
      subsurface_pass_(&fullscreen_),
      composite_pass_(&fullscreen_) {}

Handle Pipeline::Add(FrameGraph* graph, const FrameRequest& request, View view, const Size& size,
                     Handle* shadows, const TemporalFrame* temporal) {
  Settings settings = request.settings;
  settings.view = view;
  if (request.is_moving) settings.subsurface.taps = std::min(settings.subsurface.taps, kMovingTaps);
  settings.anti_aliasing =
      Chosen(settings.anti_aliasing, !is_software_ || !NeedsSkinPipeline(view, settings));
  TextureDesc desc{size.width, size.height, PixelFormat::kRgba16F, settings.anti_aliasing.samples};
  if (temporal != nullptr) {
    desc.width = temporal->width;
    desc.height = temporal->height;
  }
  Handle shown;
  Skin skin;
  Handle bloom;
  const bool casts = settings.shadow.filter != ShadowFilter::kOff && settings.shadow.lamps > 0;
  // The picture and all tiles of its strip share the maps, so only the first view adds the pass.
  if (casts && NeedsSkinPipeline(view, settings) && shadows->version < 0) {
    *shadows = shadow_pass_.Add(graph, request,
                                temporal == nullptr ? nullptr : &temporal->history->shadows);
  }
  if (view == View::kShadowMaps && casts) {
    desc.samples = 1;
    shown = AddShadowMaps(graph, *shadows, desc);
  } else if (NeedsSkinPipeline(view, settings)) {
    skin = AddSkin(graph, request, settings, desc, *shadows,
                   temporal == nullptr ? glm::vec2(0.0f) : temporal->jitter);
    shown = skin.shown;
    desc.samples = 1;
    if (view == View::kFinal || view == View::kBloom) {
      bloom = AddBloomPass(graph, shown, desc, settings, &fullscreen_);
    }
    if (view == View::kBloom && bloom.version >= 0) {
      shown = AddShowPass(graph, bloom, {.scale = kBloomScale}, desc, &fullscreen_);
      // Shown itself, so it is not added to the picture.
      bloom = {};
    }
  } else {
    shown =
        scene_pass_.AddPlain(graph, settings, {desc.width, desc.height, desc.format, desc.samples});
  }
  Handle picture = composite_pass_.Add(graph, shown, desc, settings, bloom);
  if (temporal != nullptr) {
    // Former pictures smooth edges; without one, FXAA must.
    if (!temporal->has_former()) picture = AddFxaaPass(graph, picture, desc, &fullscreen_);
    return AddTemporalPasses(graph, *temporal,
                             {picture, skin.lit.depth, skin.lit.motion, skin.bounds,
                              scene_->setup().camera.focus_distance()},
                             {size.width, size.height, PixelFormat::kRgba8, 1},
                             BloomReach(settings, size.height), &fullscreen_);
  }
  if (!settings.anti_aliasing.fxaa || !IsLight(view)) return picture;
  return AddFxaaPass(graph, picture, desc, &fullscreen_);
}

Pipeline::Skin Pipeline::AddSkin(FrameGraph* graph, const FrameRequest& request,
                                 const Settings& settings, const TextureDesc& desc, Handle shadows,
                                 glm::vec2 jitter) {
  const CameraFrame& camera = scene_->setup().camera;
  const float slope = camera.PixelsPerSlope(desc.height);
  // The pixels that some subject can cover, extended by one pixel, because filters read neighbours,
  // and by one for the jitter.
  const auto project = [&](const JointBounds& bounds, bool skin_only) {
    ScreenRect rect;
    if (const JointBounds::Extent* seen = scene_->seen_extent(skin_only)) {
      rect = seen->Pixels(desc.width, desc.height);
    } else {
      for (const NamedSubject& named : SubjectsOf(request)) {
        const PosedSubject& subject = *named.subject;
        rect = rect.With(bounds.Project({subject.model, subject.shapes},
                                        camera.view_projection * subject.placement, desc.width,
                                        desc.height, scene_->displacement_reach()));
      }
    }
    return rect.Grown(2, desc.width, desc.height);
  };
  const OcclusionGeometry view{.width = desc.width,
                               .height = desc.height,
                               .view_rotation = glm::mat3(camera.view),
                               .pixels_per_slope = slope,
                               .bounds = project(bounds_, false),
                               .background = SkinBackground(settings),
                               .jitter = jitter};
  const Surface surface = AddSurface(graph, settings, desc, shadows, view);
  const SkinGeometry skin{.width = desc.width,
                          .height = desc.height,
                          .focus_distance = camera.focus_distance(),
                          .pixels_per_mm = 0.001f * slope / camera.focus_distance(),
                          .bounds = project(skin_bounds_, true),
                          .surface_z = surface.lit.z};
  const Handle scattered =
      subsurface_pass_.Add(graph, surface.lit.irradiance, settings.subsurface, skin);
  return {AddShownSkin(graph, settings, desc, surface, scattered, view), surface.lit, view.bounds};
}

Handle Pipeline::AddShownSkin(FrameGraph* graph, const Settings& settings, const TextureDesc& desc,
                              const Surface& surface, Handle scattered,
                              const OcclusionGeometry& view) {
  switch (settings.view) {
    case View::kScattered: return scattered;
    case View::kFinal:
    case View::kBloom:
      return AddCombinePass(graph, scattered, surface.lit, desc, view.bounds, view.background,
                            &fullscreen_);
    case View::kIrradiance: return surface.lit.irradiance;
    case View::kDepth:
    case View::kOcclusion: return AddShown(graph, surface, settings.view, desc);
    default: return surface.unoccluded;  // the lighting shader drew only what the view shows
  }
}

// Two orders of the same steps. With one sample, facets are stored, occlusion is found, and each
// visible pixel is lit once, already occluded. With several samples, the scene is lit while it is
// drawn, and the occluded light is removed after resolving.
Pipeline::Surface Pipeline::AddSurface(FrameGraph* graph, const Settings& settings,
                                       const TextureDesc& desc, Handle shadows,
                                       const OcclusionGeometry& view) {
  if (desc.samples == 1) {
    const FacetTargets facets = scene_pass_.AddFacets(graph, settings, desc.width, desc.height);
    const OcclusionPass::Openness open =
        occlusion_pass_.Add(graph, facets.depth, facets.normal, settings.occlusion, view);
    const SkinTargets lit = AddLightPass(
        graph, facets, shadows, IsPartOfLight(settings.view) ? OcclusionPass::Openness{} : open,
        settings, view, scene_, &fullscreen_);
    return {lit, lit.radiance, open};
  }
  const SkinTargets scene = scene_pass_.AddSkin(
      graph, settings, {desc.width, desc.height, desc.format, desc.samples}, shadows);
  const SkinTargets lit = AddResolvePass(graph, scene, desc, &fullscreen_);
  const OcclusionPass::Openness open =
      occlusion_pass_.Add(graph, lit.depth, lit.normal, settings.occlusion, view);
  return {occlusion_pass_.AddOcclude(graph, lit, open, settings.occlusion, view), lit.radiance,
          open};
}

Handle Pipeline::AddShadowMaps(FrameGraph* graph, Handle shadows, const TextureDesc& desc) {
  const int texels = kNumLights * scene_->setup().shadow_resolution;
  const float scale = static_cast<float>(desc.width) / static_cast<float>(texels);
  return AddShowPass(graph, shadows, {.kind = ShowTarget::Kind::kMaps, .scale = scale}, desc,
                     &fullscreen_);
}

Handle Pipeline::AddShown(FrameGraph* graph, const Surface& surface, View view,
                          const TextureDesc& desc) {
  const CameraFrame& camera = scene_->setup().camera;
  ShowTarget show;
  Handle target = surface.lit.depth;
  if (view == View::kDepth) {
    // The greys span the depth of the subject around the focus, not the whole range of the depth
    // buffer.
    const float radius = 0.5f * camera.StageRadius(1.0f);
    show = {.kind = ShowTarget::Kind::kMetres,
            .near_metres = camera.focus_distance() - radius,
            .far_metres = camera.focus_distance() + radius};
  } else if (surface.open.target.version >= 0) {
    target = surface.open.target;
    show = {.kind = ShowTarget::Kind::kRed, .scale = static_cast<float>(surface.open.scale)};
  } else {
    show.kind = ShowTarget::Kind::kWhite;
  }
  return AddShowPass(graph, target, show, desc, &fullscreen_);
}

}  // namespace furrow::render
