// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "motion/clip/clip.h"
#include "recording/take_reader.h"
#include "rig/skeleton_match.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {

// A recording by path (of a take with several subjects, "take.mcap#NAME"); what its reader put up
// with is printed as warnings on standard error.
[[nodiscard]] Result<motion::Clip> LoadClipArgument(const std::string& path,
                                                    const motion::LoadOptions& options = {});

// A bar for reading a take, wiped at the end of each reading.
[[nodiscard]] recording::ReadProgress ReadingBar();

// A take by path, "take.mcap" or "take.mcap#NAME" (else `subject` is empty), that shows how far
// reading it is.
[[nodiscard]] Result<std::unique_ptr<recording::TakeReader>> OpenTakeArgument(
    const std::string& path, std::string* subject);

// Prints "furrow: warning: <text>" for each.
void PrintWarnings(const std::vector<std::string>& warnings);

// A path as it stands, else that of a rig that ships under this name, else the path as it stands
// (whose loader then says what is wrong with it).
[[nodiscard]] std::filesystem::path ResolveRigPath(const std::string& argument);

// A rig by path, or by the name of one that ships ("cmu" or "cmu.json").
[[nodiscard]] Result<wrinkle::Rig> LoadRigArgument(const std::string& argument);

// The skeleton map of --skeleton-map (a name or a file; empty: the best that ships for each
// skeleton). Where none ship and none is asked for, joints go by equal names, with a warning.
[[nodiscard]] Result<character::SkeletonMatcher> LoadSkeletonMatcher(const std::string& map);

// One warning for all joints and one for all blend shapes of the rig that a recording lacks; how
// many, and the first few. A recording of joints alone is not short of what trackers send.
void WarnOfMissing(const wrinkle::RigBinding& binding, const motion::Clip& clip);

// A character package by path; empty: the default one. `rig`: as LoadRigArgument, empty: its own.
[[nodiscard]] Result<character::Character> LoadCharacterArgument(const std::string& glb,
                                                                 const std::string& rig);

}  // namespace furrow::cli
