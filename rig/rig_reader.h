// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::character {

namespace schema {
struct Rig;
}

// From the schema's tables (rig.fbs) to wrinkle::Rig, field by field; reference poses are read and
// mixed, building blocks still included. Enumerations and what one table must hold exactly one of
// are checked here, all else by CheckRig(). The error's `where` is the field as a path.
[[nodiscard]] Result<wrinkle::Rig> ReadRigTables(const schema::Rig& tables,
                                                 const std::filesystem::path& folder,
                                                 const wrinkle::PoseSource& poses);

// Leaves out the reference poses that are parts of mixes and that no driver names.
void DropBuildingBlocks(const schema::Rig& tables, wrinkle::Rig* rig);

}  // namespace furrow::character
