// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "rig/json/rig_tables.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::character {

// The reference poses of a rig in the order of the file: written out, taken from recordings (which
// are looked up beside `folder`, then by FURROW_ASSET_PATH) or mixed from others, whatever order
// they stand in. Errors: kLimit, kCyclic (a mix that contains itself), kInvalidArgument,
// kUnsupported (a recording, and `source` is empty), those of `source`; `where` is the field.
[[nodiscard]] Status ReadReferencePoses(const TableList<schema::ReferencePose>* list,
                                        const std::filesystem::path& folder,
                                        const wrinkle::PoseSource& source,
                                        std::vector<wrinkle::ReferencePose>* poses);

}  // namespace furrow::character
