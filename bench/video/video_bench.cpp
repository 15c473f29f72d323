// SPDX-License-Identifier: Apache-2.0
// Compares H.264 with JPEG for moving pictures of a preview: the video figures of
// docs/PERFORMANCE.md.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/status.h"
#include "bench/report/aims.h"
#include "bench/report/command_line.h"
#include "bench/report/results.h"
#include "bench/report/value_or_exit.h"
#include "bench/video/measure_video.h"
#include "bench/video/scenes.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;

constexpr int kJpegQuality = 80;
constexpr int kDefaultQuality = 80;  // of a request
constexpr double kLeastFewer = 8.0;
constexpr double kMostMbit = 3.0;

struct Options {
  std::filesystem::path out = "bench-out";
  int pictures = 120;
  int large_pictures = 60;
};

std::string RateOf(const Encoded& encoded) {
  return Fixed(encoded.mbit_s, 2) + " Mbit/s at " + Fixed(encoded.psnr_db, 1) + " dB";
}

// Bits at the brightness PSNR of JPEG.
Status CompareScene(SceneDrawer* drawer, Scene scene, const Options& options,
                    std::vector<Aim>* aims) {
  const auto images = drawer->Draw(scene, 640, 400, options.pictures);
  FURROW_RETURN_IF_ERROR(images);
  const auto jpeg = MeasureJpeg(*images, kJpegQuality);
  FURROW_RETURN_IF_ERROR(jpeg);
  const auto video = VideoAt(*images, jpeg->psnr_db);
  FURROW_RETURN_IF_ERROR(video);
  const double fewer = jpeg->mbit_s / video->mbit_s;
  const bool has_aim = scene == Scene::kTurningFace;
  aims->push_back({.what = NameOf(scene) + ", 640x400, bits at equal PSNR",
                   .baseline = RateOf(*jpeg),
                   .reached = Fixed(video->mbit_s, 2) + " Mbit/s, " + Fixed(fewer, 1) +
                              "x fewer; " + Fixed(jpeg->later_mbit_s / video->later_mbit_s, 1) +
                              "x after the first second",
                   .aim = has_aim ? "8x" : "",
                   .met = !has_aim || fewer >= kLeastFewer});
  aims->push_back({.what = NameOf(scene) + ", 640x400, processor time per picture",
                   .baseline = Fixed(jpeg->cpu_ms, 2) + " ms",
                   .reached = Fixed(video->cpu_ms, 2) + " ms",
                   .met = true});
  return {};
}

// As the page asks for it.
Status MeasureLarge(SceneDrawer* drawer, Scene scene, const Options& options,
                    std::vector<Aim>* aims) {
  const auto images = drawer->Draw(scene, 1280, 720, options.large_pictures);
  FURROW_RETURN_IF_ERROR(images);
  const auto jpeg = MeasureJpeg(*images, kJpegQuality);
  FURROW_RETURN_IF_ERROR(jpeg);
  const auto video = MeasureVideo(*images, kDefaultQuality);
  FURROW_RETURN_IF_ERROR(video);
  aims->push_back({.what = NameOf(scene) + ", 1280x720 at 30 Hz",
                   .baseline = RateOf(*jpeg) + ", " + Fixed(jpeg->cpu_ms, 2) + " ms",
                   .reached = RateOf(*video) + ", " + Fixed(video->cpu_ms, 2) + " ms",
                   .aim = "below 3 Mbit/s",
                   .met = video->mbit_s < kMostMbit});
  return {};
}

int Run(const Options& options) {
  std::vector<Aim> aims;
  const auto drawer = ValueOrExit(SceneDrawer::Create());
  for (const Scene scene : {Scene::kFace, Scene::kTurningFace, Scene::kTurningCamera}) {
    Status status = CompareScene(drawer.get(), scene, options, &aims);
    if (status.ok() && scene != Scene::kFace)
      status = MeasureLarge(drawer.get(), scene, options, &aims);
    if (!status.ok()) {
      std::fprintf(stderr, "bench_video: %s\n", status.ToString().c_str());
      return 1;
    }
  }
  const std::string markdown = ToMarkdown(aims, "");
  std::printf("%s\n", markdown.c_str());
  WriteResult(options.out / "video.md", markdown);
  WriteResult(options.out / "video.json", ToJson(aims).dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{"Compare H.264 with JPEG for moving pictures, at 30 pictures per second"};
  app.add_option("--out", options.out, "Folder for video.md and video.json")->capture_default_str();
  app.add_option("--pictures", options.pictures, "Pictures per scene of 640x400")
      ->check(CLI::Range(31, 10'000))
      ->capture_default_str();
  app.add_option("--large-pictures", options.large_pictures, "Pictures per scene of 1280x720")
      ->check(CLI::Range(31, 10'000))
      ->capture_default_str();
  furrow::bench::ReadCommandLine(app, argc, argv);
  furrow::bench::MakeResultFolder(options.out);
  return furrow::bench::Run(options);
}
