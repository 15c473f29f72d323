// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "rig/json/rig_tables.h"
#include "rig/rig_reference_pose.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::rig {

// Reads the reference poses of a rig in the order of the file: lists of joints and blend shapes,
// frames of recordings (searched in `folder`, then in FURROW_ASSET_PATH) and mixes, which may
// precede their parts. Errors: kLimit, kCyclic (a mix that contains itself), kInvalidArgument,
// kUnsupported (a recording with an empty `source`), and those of `source`; `where` is the field.
// `recorded` becomes the skeleton of the first recording, unless it has joints already.
// `missing` may be null; see LoadRig(). `anchors`: see ReferencePoseFromFrame().
[[nodiscard]] Status ReadReferencePoses(const TableList<schema::ReferencePose>* list,
                                        const std::filesystem::path& folder,
                                        const wrinkle::PoseSource& source,
                                        std::vector<wrinkle::ReferencePose>* poses,
                                        wrinkle::Skeleton* recorded, std::set<std::string>* missing,
                                        const PoseAnchors& anchors = {});

}  // namespace furrow::rig
