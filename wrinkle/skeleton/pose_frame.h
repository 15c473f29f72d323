// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// One frame of a recording: the pose and the skeleton it was recorded on.
struct PoseFrame {
  Skeleton skeleton;  // may be empty: blend shapes alone
  LocalPose pose;     // skeleton.num_joints() joints
  // Of pose.blend_shapes, in their order. Those without a name, "", are ignored.
  std::vector<std::string> blend_shape_names = {};
};

// Loads a pose that a wrinkle rig references by file and frame, so that the reader of rigs needs no
// recording formats. motion/pose_source.h has an implementation, which programs pass in.
//
// `path` exists; `frame` counts from 0. Errors name the file (kNotFound, kParse, kInvalidArgument
// for a missing frame, ...). A source may be called often for one file and should cache the last
// one.
using PoseSource = std::function<Result<PoseFrame>(const std::filesystem::path& path, int frame)>;

}  // namespace furrow::wrinkle
