// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <system_error>

#include "base/ascii.h"
#include "base/files.h"
#include "base/text.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/output/take_conversion.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "recording/take_poses.h"

namespace furrow::cli {
namespace {

struct ConvertOptions {
  std::string in;
  std::string out;
  bool weights = false;
  motion::LoadOptions load;
};

// True if the path has one of the extensions, in any case.
bool HasExtension(const std::string& path, std::initializer_list<std::string_view> extensions) {
  const std::string extension = AsciiLower(std::filesystem::path(path).extension().string());
  return std::ranges::find(extensions, extension) != extensions.end();
}

// Protects the input file from being overwritten.
Status CheckOut(const ConvertOptions& options) {
  if (options.weights && !HasExtension(options.out, {".csv"})) {
    return {StatusCode::kInvalidArgument, "weights are written as .csv", options.out,
            "choose a file name with this extension"};
  }
  if (!HasExtension(options.out, {".bvh", ".glb", ".csv", ".mcap"})) {
    return {StatusCode::kUnsupported, "recordings are written as .bvh, .glb, .csv or .mcap",
            options.out, "choose a file name with one of these extensions, without a subject"};
  }
  std::string in;
  std::string subject;
  recording::SplitTakePath(options.in, &in, &subject);
  std::error_code error;
  // The same file by another name, such as a link, counts as well.
  if (std::filesystem::equivalent(in, options.out, error)) {
    return {StatusCode::kInvalidArgument,
            "the output is the input file, which must not be written over itself", options.out,
            "choose another name"};
  }
  return {};
}

int ConvertWeights(const ConvertOptions& options) {
  if (!recording::IsTakePath(options.in))
    return Fail({StatusCode::kInvalidArgument, "only takes (.mcap) contain weights", options.in,
                 "'furrow solve' computes weights from any recording"});
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
  PrintMatchesOf({&clip->skeleton, 1});
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
      app.add_subcommand("convert", "Convert a recording to another format, by file extension");
  command
      ->add_option(
          "IN", options->in,
          "Recording to read: .bvh, .glb, .gltf, .vrma, .fbx, .dae, .csv (Live Link Face), "
          ".mhpose (MakeHuman expression) or .mcap (FILE.mcap#SUBJECT)")
      ->required();
  command
      ->add_option(
          "OUT", options->out,
          "File to write: .bvh, .glb or .csv, which is replaced if it exists, or a new .mcap")
      ->required();
  command->add_flag(
      "--weights", options->weights,
      "Write the recorded weights of a take as CSV (frame,time,<names>) instead of poses");
  command
      ->add_option("--scale", options->load.scale,
                   "Factor for all lengths; BVH files do not state their unit")
      ->check(Within(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option(
          "--sample-rate", options->load.sample_rate,
          "Sample rate in Hz for formats that store curves; 0 uses the key times of the file")
      ->check(Within(0.0, 1000.0))
      ->capture_default_str();
  AddReadOptions(*command, options->load);
  command->callback([options, &action] { action = [options] { return ConvertFile(*options); }; });
}

}  // namespace furrow::cli
