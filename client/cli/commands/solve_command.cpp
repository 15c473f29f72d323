// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>

#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/progress.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/output/weight_writer.h"
#include "motion/clip/capture_time.h"
#include "motion/clip/clip.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {
namespace {

struct SolveOptions {
  std::string file;
  std::string rig;
  std::string skeleton_map;
  std::string shape_map;
  motion::LoadOptions read;
  TableFormat format = TableFormat::kCsv;
  int level = 0;  // number of drivers; 0: all
  bool drivers = false;
  bool no_filter = false;
  bool allow_missing = false;
};

// Suggests --allow-missing if the recording lacks joints or blend shapes.
Status BindingFailed(const Status& status, const SolveOptions& options) {
  if (status.code() != StatusCode::kNotFound || options.allow_missing)
    return status.At(options.rig);
  return {status.code(), status.what(), options.rig,
          "with --allow-missing, the drivers of missing joints and blend shapes stay at 0"};
}

int SolveFile(const SolveOptions& options) {
  const auto clip = LoadClipArgument(options.file, options.read);
  if (!clip.ok()) return Fail(clip.status());
  const auto input = LoadRigInput(options.rig, options.read, options.skeleton_map);
  if (!input.ok()) return Fail(input.status());
  const wrinkle::Rig& rig = input->rig;
  const auto matcher = LoadSkeletonMatcher(options.skeleton_map, input->character.get());
  if (!matcher.ok()) return Fail(matcher.status());
  const auto match = MatchJoints(*matcher, *clip, rig, input->skeleton());
  const auto shape_matcher = LoadShapeMatcher(options.shape_map);
  if (!shape_matcher.ok()) return Fail(shape_matcher.status());
  const rig::RigShapes shapes =
      MatchBlendShapes(*shape_matcher, *clip, rig,
                       MatchFaceJoints(*shape_matcher, *clip, match, input->character.get()));
  auto binding = wrinkle::RigBinding::Create(rig, clip->skeleton, shapes.driver_names(),
                                             match.Options(options.allow_missing));
  if (!binding.ok()) return Fail(BindingFailed(binding.status(), options));
  WarnAboutMissing(*binding, *clip);

  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(std::move(*binding)),
                                !options.no_filter);
  if (options.level > 0) solver.set_num_drivers(static_cast<std::size_t>(options.level));
  const auto writer = WeightWriter::Create(options.format);
  writer->Names(options.drivers ? solver.binding().driver_value_names()
                                : solver.binding().weight_names());
  Progress progress("solving", clip->num_frames());
  wrinkle::LocalPose pose;
  for (int frame = 0; frame < clip->num_frames(); ++frame) {
    clip->GetPose(frame, &pose);
    shapes.Extend(&pose);
    if (solver.Update(pose, motion::CaptureStep(*clip, frame)) != wrinkle::JobStatus::kOk) {
      return Fail({StatusCode::kInternal, "frame " + std::to_string(frame) + " could not be solved",
                   options.file, "please report this file"});
    }
    const auto values = options.drivers ? solver.driver_values() : solver.wrinkle_weights();
    if (!writer->Row({frame, clip->times[frame] - clip->times[0], {}}, values)) {
      return StandardOutputFailed();
    }
    progress.Set(frame + 1);
  }
  return kDone;
}

}  // namespace

void AddSolve(CLI::App& app, Action& action) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App* command = app.add_subcommand(
      "solve", "Compute the weights of a recording offline, as the daemon would send them");
  command
      ->add_option("FILE", options->file,
                   "Recording: BVH, glTF/GLB, VRMA, FBX, Collada, Live Link Face CSV or a take "
                   "(.mcap); or the "
                   "name of a shipped recording (performance, walk, ...)")
      ->required();
  command
      ->add_option("--rig", options->rig,
                   "Wrinkle rig: a JSON file, the name of a shipped rig (cmu, arkit, ...), or a "
                   "character (.glb, or a shipped name), whose rig is used")
      ->required();
  AddSkeletonMap(*command, options->skeleton_map);
  AddShapeMap(*command, options->shape_map);
  AddReadOptions(*command, options->read);
  const std::map<std::string, TableFormat> formats{{"csv", TableFormat::kCsv},
                                                   {"jsonl", TableFormat::kJsonl}};
  AddChoice(*command, "--format", options->format, formats, "Output format");
  command->add_flag("--drivers", options->drivers,
                    "Print driver values, before modulation and filter, instead of weights");
  command
      ->add_option("--level", options->level,
                   "Level of detail: use only the first N drivers of the rig (default: all)")
      ->check(Within(1, 1e9));
  command->add_flag("--no-filter", options->no_filter, "Do not filter the weights");
  command->add_flag("--allow-missing", options->allow_missing,
                    "Accept missing joints and blend shapes; their drivers stay at 0");
  command->callback([options, &action] { action = [options] { return SolveFile(*options); }; });
}

}  // namespace furrow::cli
