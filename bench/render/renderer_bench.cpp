// SPDX-License-Identifier: Apache-2.0
// Milliseconds per picture of the character in FURROW_BENCH_CHARACTER (a .glb file) or, by default,
// of the procedural head of the tests.
#include <cstdlib>
#include <sstream>
#include <string>

#include <benchmark/benchmark.h>

#include "bench/report/value_or_exit.h"
#include "character/package/package.h"
#include "motion/pose_source.h"
#include "render/gl/pass_timer.h"
#include "render/renderer.h"
#include "render/settings/named_settings.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

character::Character LoadSubject() {
  const char* path = std::getenv("FURROW_BENCH_CHARACTER");
  if (path == nullptr) return test::MakeHead();
  return bench::ValueOrExit(character::LoadCharacter(path, {}, motion::CachedPoseSource()));
}

class Scene {
 public:
  Scene() : character_(LoadSubject()), subject_(character_) {
    auto renderer = Renderer::Create(character_);
    if (!renderer.ok()) std::abort();
    renderer_ = std::move(*renderer);
    std::fill(subject_.weights.begin(), subject_.weights.end(), 0.7f);
    request_.model = subject_.model;
    request_.binding = &subject_.binding;
    request_.wrinkle_weights = subject_.weights;
    request_.filtered_values = subject_.driver_values;
    request_.camera = *renderer_->Preset("face");
  }

  // The smallest movement. A live subject never holds still, so cached results must not be reused.
  void Move() {
    step_ = -step_;
    subject_.model[0][3].y += step_;
  }

  character::Character character_;
  test::Subject subject_;
  float step_ = 1e-5f;  // metres
  std::unique_ptr<Renderer> renderer_;
  FrameRequest request_;
};

Scene& TheScene() {
  static Scene scene;
  return scene;
}

void BM_Render(benchmark::State& state) {
  Scene& scene = TheScene();
  FrameRequest request = scene.request_;
  request.settings.wrinkles = state.range(1) != 0;
  request.width = request.height = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(scene.renderer_->Render(request));
}
BENCHMARK(BM_Render)
    ->ArgNames({"size", "wrinkles"})
    ->ArgsProduct({{320, 640, 1024}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// Two frames in flight, as in the daemon.
void BM_Pipelined(benchmark::State& state) {
  Scene& scene = TheScene();
  FrameRequest request = scene.request_;
  for (auto _ : state) {
    if (scene.renderer_->in_flight() == 2) {
      benchmark::DoNotOptimize(scene.renderer_->Poll(true));
    }
    if (!scene.renderer_->Submit(request).ok()) std::abort();
  }
  while (scene.renderer_->in_flight() > 0) (void)scene.renderer_->Poll(true).ok();
}
BENCHMARK(BM_Pipelined)->Unit(benchmark::kMillisecond)->UseRealTime();

// FURROW_BENCH_SET="shadow.filter=off bloom.strength=0" measures the cost of settings.
void SetFromEnvironment(Settings* settings) {
  const char* text = std::getenv("FURROW_BENCH_SET");
  std::istringstream assignments(text == nullptr ? "" : text);
  for (std::string assignment; assignments >> assignment;) {
    if (!SetSetting(assignment, settings).ok()) std::abort();
  }
}

void CountPasses(Scene* scene, const FrameRequest& request, benchmark::State* state) {
  constexpr int kFrames = 5;
  PassTimer timer;
  scene->renderer_->SetObserver(&timer);
  for (int frame = 0; frame < kFrames; ++frame) {
    scene->Move();
    if (!scene->renderer_->Render(request).ok()) std::abort();
  }
  scene->renderer_->SetObserver(nullptr);
  for (const PassTime& time : timer.Take()) {
    state->counters[time.pass] += time.cpu_ms / kFrames;
  }
}

FrameRequest SkinRequest(const Scene& scene) {
  FrameRequest request = scene.request_;
  request.width = 640;
  request.height = 400;
  request.settings.shading = Shading::kSkin;
  request.is_moving = true;
  SetFromEnvironment(&request.settings);
  return request;
}

// Two frames in flight. CPU time covers all threads. The counters are milliseconds of processor
// time per pass, with a wait for the device between passes (render/gl/pass_timer.h).
void DrawFrames(const FrameRequest& request, benchmark::State& state) {
  Scene& scene = TheScene();
  // The first frames compile shaders, build tables and compose wrinkles.
  constexpr int kWarmUp = 4;
  for (int frame = 0; frame < kWarmUp; ++frame) {
    scene.Move();
    if (!scene.renderer_->Render(request).ok()) std::abort();
  }
  for (auto _ : state) {
    if (scene.renderer_->in_flight() == 2) {
      benchmark::DoNotOptimize(scene.renderer_->Poll(true));
    }
    scene.Move();
    if (!scene.renderer_->Submit(request).ok()) std::abort();
  }
  while (scene.renderer_->in_flight() > 0) (void)scene.renderer_->Poll(true).ok();
  CountPasses(&scene, request, &state);
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

// Skin shading as on a laptop or a small server. Uses FXAA if the scene has one sample.
void BM_Skin(benchmark::State& state) {
  FrameRequest request = SkinRequest(TheScene());
  request.settings.subsurface.method = static_cast<SubsurfaceMethod>(state.range(0));
  request.settings.anti_aliasing.samples = static_cast<int>(state.range(1));
  request.settings.anti_aliasing.fxaa = state.range(1) == 1;
  state.SetLabel(GetSetting("subsurface.method", request.settings));
  DrawFrames(request, state);
}
BENCHMARK(BM_Skin)
    ->ArgNames({"method", "samples"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {1, 4}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// A stream of pictures that are drawn with fewer pixels and completed from former ones. `percent`:
// of the width and height.
void BM_Stream(benchmark::State& state) {
  FrameRequest request = SkinRequest(TheScene());
  request.stream = 1 + static_cast<std::uint64_t>(state.range(0));
  request.scale = 0.01f * static_cast<float>(state.range(0));
  DrawFrames(request, state);
}
BENCHMARK(BM_Stream)
    ->ArgName("percent")
    ->Arg(75)
    ->Arg(60)
    ->Arg(50)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void BM_Encode(benchmark::State& state) {
  Scene& scene = TheScene();
  const auto image = scene.renderer_->Render(scene.request_);
  const auto format = state.range(0) == 0 ? ImageFormat::kJpeg : ImageFormat::kPng;
  for (auto _ : state) benchmark::DoNotOptimize(EncodeImage(*image, format));
}
BENCHMARK(BM_Encode)->ArgName("png")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace furrow::render

BENCHMARK_MAIN();
