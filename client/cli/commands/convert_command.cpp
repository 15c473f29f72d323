// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>

#include "base/ascii.h"
#include "base/files.h"
#include "client/cli/command.h"
#include "client/cli/exit_code.h"
#include "client/cli/inputs.h"
#include "client/cli/output/take_output.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "recording/take_poses.h"
#include "report/words.h"

namespace furrow::cli {
namespace {

using report::Counted;

struct ConvertOptions {
  std::string in;
  std::string out;
  bool weights = false;
  motion::LoadOptions load;
};

bool HasExtension(const std::string& path, std::initializer_list<std::string_view> extensions) {
  const std::string extension = AsciiLower(std::filesystem::path(path).extension().string());
  return std::ranges::find(extensions, extension) != extensions.end();
}

// What is read stays as it was, and so does every take: there is no second one of it.
Status CheckOut(const ConvertOptions& options) {
  if (options.weights && !HasExtension(options.out, {".csv"})) {
    return {StatusCode::kInvalidArgument, "weights are written as .csv", options.out,
            "give a name that ends so"};
  }
  if (!HasExtension(options.out, {".bvh", ".glb", ".csv", ".mcap"})) {
    return {StatusCode::kUnsupported, "recordings are written as .bvh, .glb, .csv or .mcap",
            options.out, "give a name that ends so, without a subject"};
  }
  std::string in;
  std::string subject;
  recording::SplitTakePath(options.in, &in, &subject);
  std::error_code error;
  if (std::filesystem::equivalent(in, options.out, error)) {
    return {StatusCode::kInvalidArgument, "a recording is not written over itself", options.out,
            "choose another name"};
  }
  return {};
}

int ConvertWeights(const ConvertOptions& options) {
  if (!recording::IsTakePath(options.in))
    return Fail({StatusCode::kInvalidArgument, "only takes (.mcap) hold weights", options.in,
                 "'furrow solve' computes them from any recording"});
  std::string subject;
  const auto take = OpenTakeArgument(options.in, &subject);
  if (!take.ok()) return Fail(take.status());
  motion::ClipReport report;
  const auto csv = WeightsToCsv(**take, subject, &report);
  PrintWarnings((*take)->file().warnings());
  PrintWarnings(report.warnings);
  if (!csv.ok()) return Fail(csv.status());
  Status status = furrow::WriteFileAtomically(options.out, *csv);
  return status.ok() ? kDone : Fail(status);
}

int ConvertFile(const ConvertOptions& options) {
  if (Status status = CheckOut(options); !status.ok()) return Fail(status);
  if (options.weights) return ConvertWeights(options);
  const auto clip = LoadClipArgument(options.in, options.load);
  if (!clip.ok()) return Fail(clip.status());
  motion::ClipReport report;
  Status status = recording::IsTakePath(options.out)
                      ? SaveTake(*clip, options.out)
                      : motion::SaveClip(*clip, options.out, &report);
  PrintWarnings(report.warnings);
  if (!status.ok()) return Fail(status);
  std::fprintf(stderr, "furrow: %s: %s, %s, %s, %.3f s\n", options.out.c_str(),
               Counted(clip->skeleton.num_joints(), "joint").c_str(),
               Counted(clip->blend_shape_names.size(), "blend shape").c_str(),
               Counted(clip->num_frames(), "frame").c_str(), clip->duration());
  return kDone;
}

}  // namespace

void AddConvert(CLI::App& app, Action& action) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "A recording in another format, by the files' extensions");
  command
      ->add_option("IN", options->in,
                   ".bvh, .glb, .gltf, .vrma, .csv (Live Link Face) or .mcap (FILE.mcap#SUBJECT)")
      ->required();
  command->add_option("OUT", options->out, ".bvh, .glb or .csv, which is replaced, or a new .mcap")
      ->required();
  command->add_flag(
      "--weights", options->weights,
      "Of a take: write its recorded weights as CSV (frame,time,<names>) instead of poses");
  command->add_option("--scale", options->load.scale, "Multiplies every length (BVH has no unit)")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option("--sample-rate", options->load.sample_rate,
                   "Hz for formats made of curves; 0: the file's own keys")
      ->check(Within(0.0, 1000.0))
      ->capture_default_str();
  const std::map<std::string, motion::BvhPositions> positions{
      {"replace", motion::BvhPositions::kReplace}, {"add", motion::BvhPositions::kAdd}};
  AddChoice(*command, "--bvh-positions", options->load.bvh_positions, positions,
            "What a BVH joint's position channels do to its offset: replace (default) or add");
  const std::map<std::string, motion::UpAxis> axes{
      {"auto", motion::UpAxis::kAuto}, {"y", motion::UpAxis::kY}, {"z", motion::UpAxis::kZ}};
  AddChoice(*command, "--up-axis", options->load.up_axis, axes,
            "Which axis points up in a BVH: auto (default), y or z");
  command->callback([options, &action] { action = [options] { return ConvertFile(*options); }; });
}

}  // namespace furrow::cli
