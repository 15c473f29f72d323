// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/import/makehuman/formats/mhm.h"
#include "base/status.h"

namespace furrow::authoring {

// What ShapePerson() did.
struct PersonShape {
  int targets = 0;    // that moved the mesh
  int modifiers = 0;  // of the save, without macros, that have targets
  std::vector<std::string> warnings;
};

// Gives the base mesh the shape of the person in `save`: adds the targets of `folder` that
// ChooseTargets() chooses. `positions`: the whole base mesh with its helpers, decimetres. Proxies and joints follow, since both are defined by vertices of the base mesh.
//
// Errors name the file: those of TargetStore::Open() and TargetStore::Read(), kLimit (the targets
// move a vertex further than 100 m).
[[nodiscard]] Result<PersonShape> ShapePerson(const std::filesystem::path& folder,
                                              const MhmSave& save, std::span<glm::vec3> positions);

}  // namespace furrow::authoring
