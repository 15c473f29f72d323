// SPDX-License-Identifier: Apache-2.0
// Measures the path of a drawn picture to its viewers: the preview figures of docs/PERFORMANCE.md.
#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "base/data_dir.h"
#include "base/status.h"
#include "bench/preview/measure_preview.h"
#include "bench/report/command_line.h"
#include "bench/report/results.h"
#include "character/package/package.h"
#include "motion/pose_source.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::bench {
namespace {

struct Options {
  PreviewSetup setting;
  std::filesystem::path out = "bench-out";
  int width = 1280;
  int height = 720;
};

// The default character at rest with skin shading: as hard to encode as pictures of a session.
Result<render::Image> DrawPicture(int width, int height) {
  const auto path = furrow::FindDataFile("default.glb");
  FURROW_RETURN_IF_ERROR(path);
  const auto character = character::LoadCharacter(*path, {}, motion::CachedPoseSource());
  FURROW_RETURN_IF_ERROR(character);
  const auto renderer = render::Renderer::Create(*character);
  FURROW_RETURN_IF_ERROR(renderer);
  const wrinkle::Skeleton& skeleton = character->skeleton;
  std::vector<glm::mat4> model(static_cast<std::size_t>(skeleton.num_joints()));
  const wrinkle::LocalToModelJob to_model{&skeleton, skeleton.rest_pose(), model};
  if (to_model.Run() != wrinkle::JobStatus::kOk) return Status(StatusCode::kInternal, "no pose");
  render::FrameRequest request;
  request.model = model;
  request.settings.shading = render::Shading::kSkin;
  request.camera = *(*renderer)->Preset("face");
  request.width = width;
  request.height = height;
  return (*renderer)->Render(request);
}

int Run(Options options) {
  spdlog::set_level(spdlog::level::err);  // hides warnings about the subject, which has one blend
                                          // shape and no joints
  auto picture = DrawPicture(options.width, options.height);
  if (!picture.ok()) {
    std::fprintf(stderr, "bench_preview: %s\n", picture.status().ToString().c_str());
    return 1;
  }
  options.setting.picture = *std::move(picture);
  const auto aims = MeasurePreview(options.setting);
  const std::string markdown = ToMarkdown(aims, "");
  std::printf("%s\n", markdown.c_str());
  WriteResult(options.out / "preview.md", markdown);
  WriteResult(options.out / "preview.json", ToJson(aims).dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{"Measure the path of drawn pictures to their viewers, also while viewers stall"};
  app.add_option("--out", options.out, "Folder for preview.md and preview.json")
      ->capture_default_str();
  app.add_option("--rounds", options.setting.rounds, "Pictures for the delivery time")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--stall", options.setting.stall_seconds, "Duration of a stall in seconds")
      ->check(CLI::Range(0.5, 25.0))
      ->capture_default_str();
  app.add_option("--viewers", options.setting.viewers, "Viewers for the other figures")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  furrow::bench::ReadCommandLine(app, argc, argv);
  furrow::bench::MakeResultFolder(options.out);
  return furrow::bench::Run(options);
}
