// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>

#include "base/files.h"
#include "base/text.h"
#include "character/package/rig_patch.h"
#include "client/cli/authoring/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/standard_output.h"
#include "motion/clip/clip.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

struct PatchArguments {
  std::string character;
  std::string rig;
  std::string around;
  std::string joint;
  std::string region;
  std::string direction = "0,1,0";
  std::string out;
  motion::LoadOptions poses;  // of the rig
  float radius_mm = 15.0f;
  character::PatchOptions patch;
};

// Parses "x,y,z".
bool ParseVector(const std::string& text, glm::vec3* vector) {
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0 && (at == end || *at++ != ',')) return false;
    const auto read = std::from_chars(at, end, (*vector)[axis]);
    if (read.ec != std::errc()) return false;
    at = read.ptr;
  }
  return at == end;
}

CLI::Validator VectorValidator() {
  return {[](std::string& text) {
            glm::vec3 vector;
            return ParseVector(text, &vector) ? std::string() : "'" + text + "' is not X,Y,Z";
          },
          "X,Y,Z"};
}

Result<glm::vec3> Centre(const PatchArguments& arguments, const character::Character& character) {
  if (!arguments.joint.empty()) return character::JointPosition(character, arguments.joint);
  if (!arguments.region.empty()) return character::RegionPosition(character, arguments.region);
  glm::vec3 centre(0.0f);
  ParseVector(arguments.around, &centre);
  return centre;
}

int Patch(const PatchArguments& arguments) {
  const auto character = LoadCharacterArgument(arguments.character, arguments.rig, arguments.poses);
  if (!character.ok()) return Fail(character.status());
  const auto centre = Centre(arguments, *character);
  if (!centre.ok()) return Fail(centre.status());
  character::PatchOptions options = arguments.patch;
  options.centre = *centre;
  options.radius = 0.001f * arguments.radius_mm;
  ParseVector(arguments.direction, &options.direction);
  const auto driver = character::CutPatch(*character, options);
  if (!driver.ok()) return Fail(driver.status());
  const std::string json = rig::DriverToJson(*driver);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(json.data()),
                                            json.size());
  if (!arguments.out.empty()) {
    const Status written = WriteFileAtomically(arguments.out, AsText(bytes));
    return written.ok() ? kDone : Fail(written);
  }
  return WriteStandardOutput(bytes).ok() ? kDone : StandardOutputFailed();
}

}  // namespace

void AddRigPatch(CLI::App& app, Action& action) {
  CLI::App* group = app.add_subcommand("rig", "Author wrinkle rigs");
  group->require_subcommand(1);
  auto arguments = std::make_shared<PatchArguments>();
  CLI::App* command = group->add_subcommand("patch", HelpOf("rig patch"));
  command->add_option("CHARACTER", arguments->character, kCharacterHelp)->required();
  command->add_option(
      "--rig", arguments->rig,
      "Wrinkle rig, by file or shipped name (default: the rig beside the character)");
  command->add_option("--name", arguments->patch.name, "Name of the driver")->capture_default_str();
  command->add_option("--mesh", arguments->patch.mesh,
                      "Cut from this mesh only (default: all meshes)");
  CLI::Option_group* where =
      command->add_option_group("where", "Centre of the patch (exactly one of these)");
  where->add_option("--around", arguments->around, "A point in model space at rest, in metres")
      ->check(VectorValidator());
  where->add_option("--joint", arguments->joint, "Origin of this joint");
  where->add_option("--region", arguments->region, "Centre of this region's mask");
  where->require_option(1);
  command->add_option("--radius", arguments->radius_mm, "Radius of the patch, in millimetres")
      ->check(Within(0.1, 1000.0))
      ->capture_default_str();
  command
      ->add_option(
          "--direction", arguments->direction,
          "Direction of \"along\", in model axes at rest; it is projected onto the surface")
      ->check(VectorValidator())
      ->capture_default_str();
  command
      ->add_option("--full", arguments->patch.full_compression,
                   "Compression that gives a weight of 1")
      ->check(Within(0.01, 1.0))
      ->capture_default_str();
  command->add_option("--out", arguments->out, "File to write (default: standard output)");
  AddBvhOptions(*command, arguments->poses);
  command->callback([arguments, &action] { action = [arguments] { return Patch(*arguments); }; });
}

}  // namespace furrow::cli
