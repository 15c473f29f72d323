// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "recording/take_poses.h"

namespace furrow::recording {

// The poses as a clip, in the stream's own units times `scale`. Partial poses build on the ones
// before them. Errors: Skeleton::Create()'s, kLimit.
[[nodiscard]] Result<motion::Clip> ToClip(const TakePoses& poses, float scale = 1.0f);

// Loads one subject of a take as a clip: "take.mcap" or "take.mcap#NAME" (SplitTakePath()).
// `progress` is told how far reading it is. Errors: TakePoses::Load()'s and ToClip()'s.
[[nodiscard]] Result<motion::Clip> LoadTakeClip(const std::string& path, float scale = 1.0f,
                                                motion::ClipReport* report = nullptr,
                                                ReadProgress progress = nullptr);

}  // namespace furrow::recording
