// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "base/files.h"
#include "base/text.h"
#include "character/package/package.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "gltf/document/document.h"
#include "gltf/limits.h"
#include "rig/shapes/shape_map_check.h"

namespace furrow::cli {
namespace {

struct ShapeMapOptions {
  std::string file;
  std::string out;
};

int CheckMap(const ShapeMapOptions& options) {
  const auto map = rig::LoadShapeMap(options.file);
  if (!map.ok()) return Fail(map.status());
  std::fputs(rig::ToText(rig::CheckShapeMap(*map)).c_str(), stdout);
  return kDone;
}

// The names of the morph targets of all meshes of a glTF file, animated or not.
Result<std::vector<std::string>> MorphTargetNames(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path, gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  const auto document = gltf::Document::Open(
      *bytes, {.contents = gltf::Contents::kAnimation, .folder = path.parent_path()});
  if (!document.ok()) return document.status().Within(path.string());
  std::vector<std::string> names;
  std::set<std::string> seen;  // a face and its teeth often share names
  for (std::size_t mesh = 0; mesh < document->num_meshes(); ++mesh) {
    for (const std::string& name : document->MorphTargetNames(static_cast<int>(mesh))) {
      if (seen.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

Result<std::vector<std::string>> ShapeNamesOf(const std::string& file) {
  const std::filesystem::path path = character::FindCharacterFile(file);
  const bool is_gltf =
      path.extension() == ".glb" || path.extension() == ".gltf" || path.extension() == ".vrm";
  if (is_gltf) return MorphTargetNames(path);
  const auto clip = LoadClipArgument(file);
  FURROW_RETURN_IF_ERROR(clip);
  return clip->blend_shape_names;
}

int Propose(const ShapeMapOptions& options) {
  const auto names = ShapeNamesOf(options.file);
  if (!names.ok()) return Fail(names.status());
  if (names->empty()) {
    return Fail(
        {StatusCode::kNotFound, "the file has no blend shapes and no morph targets", options.file});
  }
  const auto known = rig::LoadShippedShapeMaps();
  if (!known.ok()) return Fail(known.status());
  const std::string name = std::filesystem::path(options.out).stem().string();
  const std::string text = rig::ProposeShapeMap(name, *names, *known);
  // Odd names must not produce a file that Furrow itself rejects.
  const auto map = rig::ParseShapeMap(text, options.out);
  if (!map.ok()) return Fail(map.status());
  if (Status status = WriteFileAtomically(options.out, text); !status.ok()) return Fail(status);
  const auto report = rig::CheckShapeMap(*map);
  std::printf("%s: %s, %zu with a formula from a shipped map\n", options.out.c_str(),
              Counted(report.num_shapes, "shape").c_str(), report.num_from_arkit);
  return kDone;
}

}  // namespace

void AddShapeMapCommand(CLI::App& app, Action& action) {
  CLI::App* group =
      app.add_subcommand("shape-map", "Check maps of blend-shape names and write a first one");
  group->require_subcommand(1);
  auto options = std::make_shared<ShapeMapOptions>();
  CLI::App* check =
      group->add_subcommand("check", "Validate a shape map and report likely mistakes");
  check->add_option("MAP", options->file, "Shape map: a JSON file, or the name of a shipped map")
      ->required();
  check->callback([options, &action] { action = [options] { return CheckMap(*options); }; });
  CLI::App* propose = group->add_subcommand(
      "propose", "Write a first shape map for the names of a file, to be completed by hand");
  propose
      ->add_option("FILE", options->file,
                   "Character (.glb, .gltf, .vrm, or a shipped name), or a recording with blend "
                   "shapes")
      ->required();
  propose->add_option("--out", options->out, "Shape map to write (JSON)")->required();
  propose->callback([options, &action] { action = [options] { return Propose(*options); }; });
}

}  // namespace furrow::cli
