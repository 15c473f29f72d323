// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"
#include "recording/take_poses.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::recording {

// The skeleton of an offer, whose lengths `scale` multiplies; empty if it has no joints. Errors:
// those of Skeleton::Create().
[[nodiscard]] Result<wrinkle::Skeleton> SkeletonOf(const protocol::SkeletonOffer& offer,
                                                   float scale);

// Converts poses to a clip. `scale` multiplies every length. Joints and blend shapes that a partial
// pose leaves out keep their previous values. Errors: those of Skeleton::Create(), and kLimit
// (motion/clip/limits.h).
[[nodiscard]] Result<motion::Clip> ToClip(const TakePoses& poses, float scale = 1.0f);

// Loads one subject of a take as a clip. `path` is "take.mcap" or "take.mcap#NAME" (see
// SplitTakePath()). `report` may be null and `progress` empty. Errors: those of TakePoses::Load()
// and ToClip().
[[nodiscard]] Result<motion::Clip> LoadTakeClip(const std::string& path, float scale = 1.0f,
                                                motion::ClipReport* report = nullptr,
                                                ReadProgress progress = nullptr);
// The same for the first subject of the bytes of a take; of further ones, `report` gets a warning.
// `name`: of the file, in messages. Errors: those of TakePoses::LoadAll() and ToClip().
[[nodiscard]] Result<motion::Clip> ParseTakeClip(std::span<const std::uint8_t> bytes,
                                                 const std::string& name,
                                                 motion::ClipReport* report = nullptr);

}  // namespace furrow::recording
