// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/person.h"

#include <system_error>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/import/makehuman/formats/mhtarget.h"
#include "authoring/import/makehuman/save/target_library.h"
#include "base/files.h"

namespace furrow::authoring {
namespace {

constexpr float kFar = 1000.0f;  // decimetres

// Installed programs of MakeHuman pack their targets into one file of NumPy's format.
Status NoTargets(const std::filesystem::path& folder) {
  std::error_code error;
  const bool packed = std::filesystem::exists(folder / "targets.npz", error);
  return {StatusCode::kNotFound,
          packed ? "the folder has targets.npz instead of .target files" : "contains no targets",
          (folder / "targets").string(),
          "use the data folder of MakeHuman's source, makehumancommunity/makehuman on GitHub"};
}

}  // namespace

Result<PersonShape> ShapePerson(const std::filesystem::path& folder, const MhmSave& save,
                                std::span<glm::vec3> positions) {
  const Result<TargetLibrary> library = TargetLibrary::Scan(folder / "targets");
  FURROW_RETURN_IF_ERROR(library);
  if (library->num_files() == 0) return NoTargets(folder);
  TargetChoice choice = ChooseTargets(save, *library);
  PersonShape shape;
  shape.modifiers = choice.modifiers;
  shape.warnings = std::move(choice.warnings);
  for (const ChosenTarget& chosen : choice.targets) {
    const Result<std::string> text = ReadFile(chosen.path, kMaxTextFileBytes);
    FURROW_RETURN_IF_ERROR(text);
    const Result<MhTarget> target = ParseMhTarget(*text, chosen.path.string(), positions.size());
    FURROW_RETURN_IF_ERROR(target);
    ApplyMhTarget(*target, chosen.weight, positions);
    shape.targets += target->vertices.empty() ? 0 : 1;
  }
  for (const glm::vec3& p : positions) {
    // False for NaN.
    if (!(glm::length(p) < kFar))
      return Status(StatusCode::kLimit, "the targets move a vertex further than 100 m",
                    (folder / "targets").string());
  }
  return shape;
}

}  // namespace furrow::authoring
