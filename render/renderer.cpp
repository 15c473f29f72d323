// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/status.h"
#include "render/gl/egl_context.h"
#include "render/gl/read_back.h"
#include "render/passes/finish_pass.h"
#include "render/passes/read_back_pass.h"
#include "render/pipeline.h"
#include "render/request/request_check.h"
#include "render/scene/camera_frame.h"

namespace furrow::render {
namespace {

constexpr int kTilesAcross = 6;  // ratio between the picture's size and a strip tile's

// Members are in dependency order, so that OpenGL objects are destroyed before their context.
class GlRenderer final : public Renderer {
 public:
  static Result<std::unique_ptr<Renderer>> Create(const character::Character& character,
                                                  const RendererOptions& options) {
    // The context is current from here on, as the uploads below require.
    Result<std::unique_ptr<EglContext>> context = EglContext::Create(options.device);
    FURROW_RETURN_IF_ERROR(context);
    Result<std::unique_ptr<GpuCharacter>> gpu = GpuCharacter::Create(character);
    FURROW_RETURN_IF_ERROR(gpu);
    Result<std::unique_ptr<WrinkleTables>> tables =
        WrinkleTables::Create(character, (*gpu)->layout());
    FURROW_RETURN_IF_ERROR(tables);
    return std::unique_ptr<Renderer>(new GlRenderer(character, options, std::move(*context),
                                                    std::move(*gpu), std::move(*tables)));
  }

  ~GlRenderer() override {
    // Makes the members below delete their objects in their own context. If the context is lost,
    // none is current now, and the objects are already gone.
    (void)context_->MakeCurrent().ok();
  }

  Status Submit(const FrameRequest& request) override {
    FURROW_RETURN_IF_ERROR(CheckRequest(request, skeleton_.num_joints(), num_shapes_));
    if (read_back_.in_flight() == ReadBack::kCapacity) {
      return {StatusCode::kUnavailable, "two pictures are in flight", "renderer",
              "call Poll() first"};
    }
    FURROW_RETURN_IF_ERROR(context_->MakeCurrent());
    FrameGraph graph;
    FURROW_RETURN_IF_ERROR(BuildFrame(request, &graph));
    FURROW_RETURN_IF_ERROR(graph.Compile());
    if (const std::size_t bytes = graph.PeakBytes(); bytes > pool_.max_bytes()) {
      return {StatusCode::kLimit,
              "the picture needs " + std::to_string(bytes >> 20) +
                  " MiB of textures; the limit is " + std::to_string(pool_.max_bytes() >> 20) +
                  " MiB",
              "renderer", "ask for fewer pixels or fewer anti_aliasing.samples"};
    }
    const Status status = graph.Execute(&pool_, observer_);
    pool_.EndFrame();
    if (status.ok() && temporal_ != nullptr) {
      histories_.End(request, scene_.setup().camera);
      scene_.KeepVertices(histories_.vertices());
      histories_.KeepShadows(scene_.setup().shadows, scene_.setup().shadow_resolution);
    }
    return status;
  }

  Result<Image> Poll(bool wait) override {
    FURROW_RETURN_IF_ERROR(context_->MakeCurrent());
    Result<std::optional<Image>> image = read_back_.Take(wait);
    FURROW_RETURN_IF_ERROR(image);
    return image->value_or(Image());
  }

  void Release() override { context_->Release(); }
  void SetObserver(FrameGraphObserver* observer) override { observer_ = observer; }
  int in_flight() const override { return read_back_.in_flight(); }
  bool is_software() const override { return context_->is_software(); }
  std::string description() const override { return context_->description(); }
  Result<Camera> Preset(std::string_view name) const override {
    for (const auto& [preset, camera] : presets_) {
      if (preset == name) return camera;
    }
    return UnknownPreset(name);
  }

 private:
  GlRenderer(const character::Character& character, const RendererOptions& options,
             std::unique_ptr<EglContext> context, std::unique_ptr<GpuCharacter> gpu,
             std::unique_ptr<WrinkleTables> tables)
      : skeleton_(character.skeleton),
        inverse_bind_matrices_(character.inverse_bind_matrices),
        num_shapes_(character.shapes.size()),
        presets_(CameraPresets(character)),
        context_(std::move(context)),
        pool_(&device_,
              options.max_texture_bytes == 0 ? TransientPool::kNoLimit : options.max_texture_bytes),
        histories_(&device_),
        gpu_(std::move(gpu)),
        tables_(std::move(tables)),
        scene_(skeleton_, inverse_bind_matrices_, gpu_.get(), tables_.get(), &shaders_,
               context_->is_software()),
        pipeline_(character, &scene_, &shaders_, &device_, context_->is_software()) {}

  // Uploads the frame's data once, and then declares the passes of the picture and of each tile.
  // Nothing is drawn before the graph has been compiled.
  Status BuildFrame(const FrameRequest& request, FrameGraph* graph) {
    shaders_.BeginFrame();
    temporal_ = histories_.Begin(request, is_software());
    const SceneMotion motion = temporal_ == nullptr ? SceneMotion{} : MotionOf(*temporal_);
    FURROW_RETURN_IF_ERROR(scene_.Update(request, temporal_ == nullptr ? nullptr : &motion));
    FrameGraph::Handle shadows;
    FrameGraph::Handle picture =
        pipeline_.Add(graph, request, request.settings.view, {request.width, request.height},
                      &shadows, temporal_);
    std::vector<FrameGraph::Handle> tiles;
    for (const View view : request.settings.strip.views) {
      tiles.push_back(pipeline_.Add(
          graph, request, view,
          {std::max(request.width / kTilesAcross, 1), std::max(request.height / kTilesAcross, 1)},
          &shadows));
    }
    picture = AddStripPass(graph, picture, tiles, &device_);
    const int percent =
        temporal_ == nullptr ? 100 : static_cast<int>(std::lround(100.0f * request.scale));
    AddReadBackPass(graph, picture, {request.token, percent}, &device_, &read_back_);
    return {};
  }

  const wrinkle::Skeleton skeleton_;
  const std::vector<glm::mat4> inverse_bind_matrices_;
  const std::size_t num_shapes_;
  const std::vector<std::pair<std::string, Camera>> presets_;
  std::unique_ptr<EglContext> context_;
  GlDevice device_;
  TransientPool pool_;
  Histories histories_;
  const TemporalFrame* temporal_ = nullptr;  // of the picture that is being drawn
  ShaderLibrary shaders_;
  std::unique_ptr<GpuCharacter> gpu_;
  std::unique_ptr<WrinkleTables> tables_;
  SceneDraw scene_;
  Pipeline pipeline_;
  ReadBack read_back_;
  FrameGraphObserver* observer_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::Create(const character::Character& character,
                                                   const RendererOptions& options) {
  return GlRenderer::Create(character, options);
}

Result<Renderer::Device> Renderer::FindDevice(const std::string& device) {
  const Result<std::unique_ptr<EglContext>> context = EglContext::Create(device);
  FURROW_RETURN_IF_ERROR(context);
  return Device{.is_software = (*context)->is_software()};
}

Result<Image> Renderer::Render(const FrameRequest& request) {
  while (in_flight() > 0) {  // discard pictures that were never polled
    const Result<Image> old = Poll(true);
    if (!old.ok()) return old;
  }
  FURROW_RETURN_IF_ERROR(Submit(request));
  return Poll(true);
}

}  // namespace furrow::render
