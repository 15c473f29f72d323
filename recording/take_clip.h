// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "recording/take_poses.h"

namespace furrow::recording {

// Converts poses to a clip. `scale` multiplies every length. A partial pose keeps the previous
// values of joints and blend shapes that it leaves out. Errors: Skeleton::Create()'s, kLimit.
[[nodiscard]] Result<motion::Clip> ToClip(const TakePoses& poses, float scale = 1.0f);

// Loads one subject of a take as a clip. `path` is "take.mcap" or "take.mcap#NAME" (see
// SplitTakePath()). `progress` is optional. Errors: TakePoses::Load()'s and ToClip()'s.
[[nodiscard]] Result<motion::Clip> LoadTakeClip(const std::string& path, float scale = 1.0f,
                                                motion::ClipReport* report = nullptr,
                                                ReadProgress progress = nullptr);

}  // namespace furrow::recording
