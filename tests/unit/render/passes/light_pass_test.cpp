// SPDX-License-Identifier: Apache-2.0
#include "render/passes/light_pass.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "render/gl/egl_context.h"
#include "render/mesh/joint_bounds.h"
#include "render/passes/resolve_pass.h"
#include "render/passes/subsurface_pass.h"
#include "render/renderer.h"
#include "tests/unit/render/reference/target_reader.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kLightSize = 192;

class LightPassTest : public testing::Test {
 protected:
  LightPassTest() {
    // All kinds of material that the lighting distinguishes.
    for (std::size_t i = 0; i < head_.materials.size(); ++i) {
      if (i % 2 == 1) head_.materials[i].kind = character::Material::Kind::kCloth;
    }
    renderer_ = test::Expect(Renderer::Create(head_));
    subject_.Set("l_squash", 1.0f);
    subject_.Solve();
  }

  FrameRequest Request(View view, int samples) const {
    FrameRequest request;
    request.model = subject_.model;
    request.binding = &subject_.binding;
    request.wrinkle_weights = subject_.weights;
    request.filtered_values = subject_.driver_values;
    request.camera = *renderer_->Preset("three_quarter");
    request.width = request.height = kLightSize;
    request.settings.shading = Shading::kSkin;
    request.settings.view = view;
    request.settings.anti_aliasing.samples = samples;
    return request;
  }
  Image Draw(View view, int samples) {
    return test::Expect(renderer_->Render(Request(view, samples)));
  }

  character::Character head_ = test::MakeHead();
  test::Subject subject_{head_};
  std::unique_ptr<Renderer> renderer_;
};

// One sample per pixel is lit in a separate pass; four samples are lit where they are drawn. The
// pictures agree except at edges, which four samples smooth.
TEST_F(LightPassTest, OneSampleIsLitLikeFour) {
  for (const View view :
       {View::kFinal, View::kIrradiance, View::kScattered, View::kShadow, View::kSpecular,
        View::kTranslucency, View::kAlbedo, View::kMaterial, View::kDepth, View::kOcclusion}) {
    const Image one = Draw(view, 1);
    const Image four = Draw(view, 4);
    int apart = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < one.rgb.size(); ++i) {
      const int difference = std::abs(int{one.rgb[i]} - int{four.rgb[i]});
      sum += difference;
      apart += difference > 6 ? 1 : 0;
    }
    const auto values = static_cast<double>(one.rgb.size());
    EXPECT_LT(apart / values, 0.03) << ViewName(view);
    EXPECT_LT(sum / values, 1.0) << ViewName(view);
  }
}

// The targets of the passes after lighting, drawn for the whole picture or only within the
// subject's bounds.
class RestrictedPasses : public LightPassTest {
 protected:
  struct Where {
    ScreenRect bounds;
    bool on_surface = false;
  };
  // The targets' texels by name.
  std::map<std::string, std::vector<glm::vec4>> Draw(const FrameRequest& request,
                                                     const Where& where) {
    EXPECT_TRUE(scene_.Update(request).ok());
    FrameGraph graph;
    const CameraFrame& camera = scene_.setup().camera;
    const float slope = camera.PixelsPerSlope(kLightSize);
    const OcclusionGeometry view{kLightSize, kLightSize,   glm::mat3(camera.view),
                                 slope,      where.bounds, glm::vec3(0.1f)};
    ScenePass scene_pass(&scene_, &device_);
    const FacetTargets facets =
        scene_pass.AddFacets(&graph, request.settings, kLightSize, kLightSize);
    OcclusionPass occlusion(&fullscreen_);
    const OcclusionPass::Openness open =
        occlusion.Add(&graph, facets.depth, facets.normal, request.settings.occlusion, view);
    SkinTargets lit =
        AddLightPass(&graph, facets, {}, open, request.settings, view, &scene_, &fullscreen_);
    if (!where.on_surface) lit.z = {};
    SubsurfacePass subsurface(&fullscreen_);
    const SkinGeometry skin{.width = kLightSize,
                            .height = kLightSize,
                            .focus_distance = camera.focus_distance(),
                            .pixels_per_mm = 0.001f * slope / camera.focus_distance(),
                            .bounds = where.bounds,
                            .surface_z = lit.z};
    const FrameGraph::Handle scattered =
        subsurface.Add(&graph, lit.irradiance, request.settings.subsurface, skin);
    const TextureDesc desc{kLightSize, kLightSize, PixelFormat::kRgba16F, 1};
    const FrameGraph::Handle combined =
        AddCombinePass(&graph, scattered, lit, desc, where.bounds, view.background, &fullscreen_);
    Keep(&graph, {open.target, scattered, combined});
    EXPECT_TRUE(graph.Compile().ok());
    test::TargetReader reader;
    EXPECT_TRUE(graph.Execute(&pool_, &reader).ok());
    std::map<std::string, std::vector<glm::vec4>> targets;
    for (const char* name : {"occlusion", "scattered", "combined"}) {
      targets[name] = reader.Target(name).texels;
    }
    return targets;
  }
  static void Keep(FrameGraph* graph, const std::vector<FrameGraph::Handle>& handles) {
    struct Nothing {};
    graph->AddPass<Nothing>(
        "keep",
        [&](FrameGraph::Builder& builder, Nothing&) {
          for (const FrameGraph::Handle handle : handles) builder.Read(handle);
          builder.SideEffect();
        },
        [](const FrameGraph::Resources&, const Nothing&) { return Status(); });
  }

  std::unique_ptr<EglContext> context_ = test::Expect(EglContext::Create(""));
  GlDevice device_;
  TransientPool pool_{&device_};
  ShaderLibrary shaders_;
  std::unique_ptr<GpuCharacter> gpu_ = test::Expect(GpuCharacter::Create(head_));
  std::unique_ptr<WrinkleTables> tables_ =
      test::Expect(WrinkleTables::Create(head_, gpu_->layout()));
  SceneDraw scene_{head_.skeleton, head_.inverse_bind_matrices, gpu_.get(), tables_.get(),
                   &shaders_,      context_->is_software()};
  Fullscreen fullscreen_{&shaders_, &device_};
};

TEST_F(RestrictedPasses, MatchUnrestrictedPasses) {
  for (const SubsurfaceMethod method :
       {SubsurfaceMethod::kSeparable, SubsurfaceMethod::kGaussians, SubsurfaceMethod::kBurley}) {
    FrameRequest request = Request(View::kFinal, 1);
    request.settings.subsurface.method = method;
    request.settings.shadow.filter = ShadowFilter::kOff;
    const auto whole = Draw(request, {{0, 0, kLightSize, kLightSize}, false});
    const JointBounds bounds(head_, [](const character::Material&) { return true; });
    const ScreenRect rect =
        bounds
            .Project({subject_.model, {}}, scene_.setup().camera.view_projection, kLightSize,
                     kLightSize)
            .Grown(1, kLightSize, kLightSize);
    ASSERT_LT((rect.x1 - rect.x0) * (rect.y1 - rect.y0), kLightSize * kLightSize);
    const auto restricted = Draw(request, {rect, true});
    for (const auto& [name, texels] : whole) {
      EXPECT_EQ(texels, restricted.at(name)) << name;
    }
  }
}

}  // namespace
}  // namespace furrow::render
