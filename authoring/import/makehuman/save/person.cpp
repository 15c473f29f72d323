// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/person.h"

#include <utility>

#include <glm/geometric.hpp>

#include "authoring/import/makehuman/formats/mhtarget.h"
#include "authoring/import/makehuman/save/target_library.h"
#include "authoring/import/makehuman/save/target_store.h"

namespace furrow::authoring {
namespace {

constexpr float kFar = 1000.0f;  // decimetres

}  // namespace

Result<PersonShape> ShapePerson(const std::filesystem::path& folder, const MhmSave& save,
                                std::span<glm::vec3> positions) {
  const Result<TargetStore> store = TargetStore::Open(folder);
  FURROW_RETURN_IF_ERROR(store);
  TargetChoice choice = ChooseTargets(save, store->library());
  PersonShape shape;
  shape.modifiers = choice.modifiers;
  shape.warnings = std::move(choice.warnings);
  for (const ChosenTarget& chosen : choice.targets) {
    const Result<MhTarget> target = store->Read(chosen.path, positions.size());
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
