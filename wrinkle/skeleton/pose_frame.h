// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "base/status.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// One frame of a recording: the pose and the skeleton it was recorded on.
struct PoseFrame {
  Skeleton skeleton;
  LocalPose pose;  // skeleton.num_joints() joints
};

// How a wrinkle rig that says "this file, that frame" gets its pose, without its reader knowing any
// recording format: motion/pose_source.h offers one, programs plug it in.
//
// `path` exists; `frame` counts from 0. Errors name the file (kNotFound, kParse, kInvalidArgument:
// no such frame, ...). May be called often for one file: a source should keep what it read last.
using PoseSource = std::function<Result<PoseFrame>(const std::filesystem::path& path, int frame)>;

}  // namespace furrow::wrinkle
