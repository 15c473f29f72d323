// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "rig/skeleton_match.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::rig {

// Turns the frames that `source` reads to Furrow's model space (+Y up, facing +Z), in which a rig's
// reference poses are stated. Each frame is turned by the rest pose of its own skeleton, as
// SkeletonMatcher::StanceOf() finds it and as streams are bound. Without a stance, the frames keep
// their axes, and `warn` (optional) receives a warning. Not thread-safe, and copies share the last
// stance.
//
// Pass it to LoadRig(), LoadCharacter() and others that read a rig with files of poses. Errors:
// those of `source`.
[[nodiscard]] wrinkle::PoseSource PosesInFurrowAxes(
    wrinkle::PoseSource source, SkeletonMatcher matcher,
    std::function<void(const std::string&)> warn = {});
// The same with a matcher that is made when the first frame is read: most rigs read none.
[[nodiscard]] wrinkle::PoseSource PosesInFurrowAxes(
    wrinkle::PoseSource source, std::function<SkeletonMatcher()> make_matcher,
    std::function<void(const std::string&)> warn = {});

}  // namespace furrow::rig
