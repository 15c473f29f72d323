// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::rig {

namespace schema {
struct Rig;
}

// Converts the schema's tables (RigSchemaText()) to wrinkle::Rig. Reference poses are read and
// mixed; poses that only mixes use are still included. Checks enumerations and alternatives
// ("exactly one of"); CheckRig() checks everything else. The error's `where` is the path of the
// field.
[[nodiscard]] Result<wrinkle::Rig> ReadRigTables(const schema::Rig& tables,
                                                 const std::filesystem::path& folder,
                                                 const wrinkle::PoseSource& poses,
                                                 std::set<std::string>* missing);

// Removes the reference poses that are parts of mixes and that no driver uses.
void DropBuildingBlocks(const schema::Rig& tables, wrinkle::Rig* rig);

}  // namespace furrow::rig
