// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_package.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/bake/bake_report.h"
#include "authoring/bake/strokes_file.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/surface_check.h"
#include "base/status.h"
#include "base/text.h"
#include "character/package/package.h"
#include "character/pictures/picture_file.h"
#include "client/cli/authoring/commands.h"
#include "client/cli/authoring/staged_folder.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/progress.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

enum class MapFormat { kPng, kExr };

struct BakeArguments {
  std::string character;
  std::string rig;
  std::string out;
  std::string strokes;
  std::vector<std::string> maps;
  MapFormat format = MapFormat::kPng;
  bool masks = false;
  std::vector<authoring::RegionFabric> fabrics;  // of regions, as given
  motion::LoadOptions read;
  authoring::BakeOptions options;
};

// The validated inputs of a bake.
struct BakeJob {
  character::Character character;
  authoring::CollectedPoses poses;
  std::vector<authoring::BakeStroke> strokes;
  std::vector<std::string> warnings;
};

// The path of the rig, for messages.
std::string RigName(const BakeArguments& arguments) {
  if (!arguments.rig.empty()) return ResolveRigPath(arguments.rig).string();
  return character::RigBeside(arguments.character).string();
}

fs::path NewRig(const BakeArguments& arguments) {
  return fs::path(arguments.out) / character::RigBeside(arguments.character).filename();
}

// Protects the rig that the bake starts from.
Status CheckOutput(const BakeArguments& arguments) {
  std::error_code error;
  if (!fs::equivalent(NewRig(arguments), RigName(arguments), error) || error) return {};
  return {StatusCode::kInvalidArgument, "the new rig would replace the rig it is made from",
          NewRig(arguments).string(), "choose another folder for --out"};
}

// Regions without a namesake in the rig are mistyped, and skin has no fabric.
Status CheckFabrics(const std::vector<authoring::RegionFabric>& fabrics,
                    const character::Character& character) {
  const auto is_cloth = [&](const wrinkle::Feed& feed) {
    return authoring::FoldsCloth(character, feed);
  };
  for (const authoring::RegionFabric& fabric : fabrics) {
    const auto covered = [&](const wrinkle::Region& region) {
      return fabric.Covers(region.name) && std::ranges::any_of(region.feeds, is_cloth);
    };
    if (std::ranges::any_of(character.rig.regions, covered)) continue;
    return {StatusCode::kNotFound, "the rig has no region '" + fabric.region + "' that folds cloth",
            "--fabric", "name a region, or the beginning of several: knee covers knee_l_inner"};
  }
  return {};
}

// Removes the strokes of maps that are not baked.
void KeepMaps(const std::vector<std::string>& maps, std::vector<authoring::BakeStroke>* strokes) {
  for (authoring::BakeStroke& stroke : *strokes) {
    std::erase_if(stroke.maps, [&](const std::string& map) {
      return std::ranges::find(maps, map) == maps.end();
    });
  }
  std::erase_if(*strokes, [](const authoring::BakeStroke& stroke) { return stroke.maps.empty(); });
}

Result<BakeJob> Prepare(const BakeArguments& arguments) {
  BakeJob job;
  FURROW_RETURN_IF_ERROR(CheckOutput(arguments));
  auto character = LoadCharacterArgument(arguments.character, arguments.rig, arguments.read);
  FURROW_RETURN_IF_ERROR(character);
  job.character = std::move(*character);
  FURROW_RETURN_IF_ERROR(CheckFabrics(arguments.fabrics, job.character));
  const auto shapes = LoadShapeMatcher({});
  FURROW_RETURN_IF_ERROR(shapes);
  auto poses = authoring::CollectBakePoses(job.character, arguments.maps,
                                           authoring::ArkitFace(job.character, *shapes));
  if (!poses.ok()) {
    const Status s = poses.status();
    const std::string field = s.where().empty() ? "" : ": " + s.where();
    return Status(s.code(), s.what(), RigName(arguments) + field, s.todo());
  }
  job.poses = std::move(*poses);
  const auto bakeable = authoring::CheckSurfaces(job.character, arguments.maps, &job.warnings);
  if (!bakeable.ok()) {
    const Status s = bakeable.status();
    return Status(s.code(), s.what(), arguments.character + ": " + s.where(), s.todo());
  }
  std::erase_if(job.poses.poses, [&](const authoring::BakePose& pose) {
    return std::ranges::find(bakeable->names, pose.map) == bakeable->names.end();
  });
  if (!arguments.strokes.empty()) {
    auto strokes = authoring::LoadStrokes(arguments.strokes, job.character.rig);
    FURROW_RETURN_IF_ERROR(strokes);
    job.strokes = std::move(*strokes);
    KeepMaps(bakeable->names, &job.strokes);
  }
  if (job.poses.poses.empty() && job.strokes.empty()) {
    return Status(StatusCode::kInvalidArgument, "no pose and no stroke feeds a wrinkle map",
                  RigName(arguments), "add drivers of joints to the rig, or use --strokes");
  }
  return job;
}

Result<authoring::BakedMaps> BakeWithBar(const BakeArguments& arguments, const BakeJob& job) {
  constexpr int kSteps = 1000;
  Progress bar("baking", kSteps);
  auto maps = authoring::Bake(job.character, job.poses.poses, job.strokes, arguments.options,
                              [&](float done) {
                                bar.Set(static_cast<std::int64_t>(done * kSteps));
                                return !Interrupted();
                              });
  if (maps.ok()) return maps;
  if (Interrupted()) return Status(StatusCode::kUnavailable, "interrupted; nothing was written");
  return maps.status().At(arguments.character);
}

Status WriteAll(const BakeArguments& arguments, const authoring::BakedMaps& maps, double seconds,
                BakeJob* job, StagedFolder* folder) {
  const authoring::PackageOptions options{.exr = arguments.format == MapFormat::kExr,
                                          .masks = arguments.masks};
  const auto package = authoring::PackageMaps(job->character, maps, options);
  if (!package.ok()) return package.status().At(arguments.character);
  job->warnings.insert(job->warnings.end(), package->notes.begin(), package->notes.end());
  for (const authoring::BakedFiles::File& file : package->files) {
    FURROW_RETURN_IF_ERROR(folder->Write(file.name, file.bytes));
  }
  for (const character::Picture& picture : authoring::ReportPictures(maps)) {
    const auto png = character::EncodePng(picture);
    FURROW_RETURN_IF_ERROR(png);
    FURROW_RETURN_IF_ERROR(folder->Write(picture.name, *png));
  }
  const authoring::ReportDetails facts{.character = arguments.character,
                                       .rig = RigName(arguments),
                                       .strokes = arguments.strokes,
                                       .poses = job->poses.poses,
                                       .notes = job->poses.notes,
                                       .warnings = job->warnings,
                                       .options = arguments.options,
                                       .seconds = seconds};
  FURROW_RETURN_IF_ERROR(folder->Write("report.html", authoring::ReportHtml(maps, facts)));
  return folder->Write(NewRig(arguments).filename().string(), rig::RigToJson(package->rig));
}

void PrintSummary(const BakeArguments& arguments, const BakeJob& job,
                  const authoring::BakedMaps& maps, double seconds) {
  PrintWarnings(job.warnings);
  PrintWarnings(authoring::BakeWarnings(maps, arguments.options));
  for (const authoring::BakedMap& map : maps.maps) {
    const authoring::BakedMap::Statistics& s = map.statistics;
    const double share = s.covered_texels > 0 ? static_cast<double>(s.folded_texels) /
                                                    static_cast<double>(s.covered_texels)
                                              : 0.0;
    std::fprintf(stderr, "furrow: %s on %s: %.0f%% folded, valleys to %.2f mm, ridges to %.2f mm\n",
                 map.map.c_str(), map.cloth ? "cloth" : "skin", 100.0 * share, double{s.deepest_mm},
                 double{s.highest_mm});
  }
  if (!job.poses.notes.empty()) {
    std::fprintf(stderr, "furrow: %s not baked; see report.html\n",
                 Counted(job.poses.notes.size(), "source").c_str());
  }
  std::fprintf(stderr, "furrow: %s in %.1f s; open %s/report.html, and render it with --rig %s\n",
               arguments.out.c_str(), seconds, arguments.out.c_str(), NewRig(arguments).c_str());
}

int Bake(BakeArguments arguments) {
  CatchInterrupts();
  // The rig lies beside the file, and the new rig has its name.
  arguments.character = character::FindCharacterFile(arguments.character).string();
  auto job = Prepare(arguments);
  if (!job.ok()) return Fail(job.status());
  auto folder = StagedFolder::Create(arguments.out);
  if (!folder.ok()) return Fail(folder.status());
  const std::int64_t start = SteadyMicroseconds();
  const auto maps = BakeWithBar(arguments, *job);
  if (!maps.ok()) return Fail(maps.status());
  const double seconds = static_cast<double>(SteadyMicroseconds() - start) * 1e-6;
  if (Status s = WriteAll(arguments, *maps, seconds, &*job, &*folder); !s.ok()) return Fail(s);
  if (Interrupted()) {
    return Fail({StatusCode::kUnavailable, "interrupted; nothing was written"});
  }
  if (Status s = folder->Commit(); !s.ok()) return Fail(s);
  PrintSummary(arguments, *job, *maps, seconds);
  return kDone;
}

// Reads "denim", for all cloth, and "knee=denim", for a region. Later ones count. A fabric for all
// cloth replaces the defaults of regions, too.
void SetFabrics(const std::vector<std::string>& texts, BakeArguments* arguments) {
  authoring::BakeOptions& options = arguments->options;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string name = equals == std::string::npos ? text : text.substr(equals + 1);
    const std::optional<authoring::Fabric> fabric = authoring::FindFabric(name);
    if (!fabric) {
      throw CLI::ValidationError(
          "--fabric", "unknown fabric '" + name + "'; fabrics: " + authoring::FabricNames());
    }
    if (equals == std::string::npos) {
      options.fabric = *fabric;
      options.fabrics.clear();
      arguments->fabrics.clear();
    } else {
      arguments->fabrics.insert(arguments->fabrics.begin(), {text.substr(0, equals), *fabric});
    }
  }
  options.fabrics.insert(options.fabrics.begin(), arguments->fabrics.begin(),
                         arguments->fabrics.end());
}

void AddMaterialOptions(CLI::App& command, BakeArguments& arguments) {
  authoring::BakeOptions& options = arguments.options;
  command
      .add_option("--depth", options.depth,
                  "Factor for the depth of all folds, for example to age a face")
      ->check(Within(0.0, 4.0))
      ->capture_default_str();
  command
      .add_option(
          "--share", options.skin.share,
          "Share of the compression that goes into folds of skin; the rest shortens the skin")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--skin-wavelength", options.skin.wavelength_mm,
                  "Distance between folds on skin, in millimetres, unless a region sets another")
      ->check(Within(0.2, 200.0))
      ->capture_default_str();
  command
      .add_option_function<std::vector<std::string>>(
          "--fabric",
          [&arguments](const std::vector<std::string>& texts) { SetFabrics(texts, &arguments); },
          "Fabric of all cloth, or REGION=FABRIC for a region, for example knee=denim "
          "(repeatable): " +
              authoring::FabricNames() + " (default: cotton knee=wool hip=wool ankle=wool)")
      ->type_name("[REGION=]FABRIC")
      ->allow_extra_args(false);
  command
      .add_option(
          "--ease", options.ease,
          "How much wider cloth is than the surface it lies on, as a fraction; 0 fits tightly")
      ->check(Within(0.0, 0.3))
      ->capture_default_str();
  command
      .add_option(
          "--fine-lines", options.skin.fine_lines,
          "Height of the fine lines of dry or old skin, as a fraction of their full height; they "
          "have a third of the wavelength")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option(
          "--grain", options.skin.grain,
          "How much the lines and pores of skin vary the height of its folds, as a fraction "
          "of it; 0 gives smooth folds")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--seed", options.seed,
                  "Random seed; a different seed gives different folds of the same kind")
      ->capture_default_str();
  command
      .add_option("--threads", options.threads,
                  "Number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

}  // namespace

void AddBake(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<BakeArguments>();
  arguments->options.threads =
      std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  CLI::App* command = app.add_subcommand("bake", HelpOf("bake"));
  command->add_option("CHARACTER", arguments->character, kCharacterHelp)->required();
  command->add_option(
      "--rig", arguments->rig,
      "Wrinkle rig, by file or shipped name (default: the rig beside the character)");
  command
      ->add_option("--out", arguments->out,
                   "Folder for the maps, the rig that names them and report.html")
      ->required();
  AddReadOptions(*command, arguments->read);
  command->add_option("--map", arguments->maps, "Name of a map to bake (repeatable; default: all)")
      ->allow_extra_args(false);
  command->add_option(
      "--strokes", arguments->strokes,
      "JSON file with strokes that add or remove folds, see docs/BAKE.md (default: none)");
  command->add_option("--size", arguments->options.size, "Texels per side, 64 to 4096")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  AddChoice<MapFormat>(*command, "--format", arguments->format,
                       {{"png", MapFormat::kPng}, {"exr", MapFormat::kExr}},
                       "File format: 16-bit PNG with a scale in the rig, or half-float EXR");
  command->add_flag("--masks", arguments->masks,
                    "Give each region of the rig the mask that its poses suggest");
  AddMaterialOptions(*command, *arguments);
  command->callback([arguments, &action] { action = [arguments] { return Bake(*arguments); }; });
}

}  // namespace furrow::cli
