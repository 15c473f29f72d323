// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "character/character.h"
#include "motion/clip.h"
#include "wrinkle/rig.h"
#include "wrinkle/status.h"

namespace furrow::cli {

// A recording by path; what its reader put up with is printed as warnings on standard error.
[[nodiscard]] Result<motion::Clip> LoadClipArgument(const std::string& path,
                                                    const motion::LoadOptions& options = {});

// Prints "furrow: warning: <text>" for each.
void PrintWarnings(const std::vector<std::string>& warnings);

// A path as it stands, else that of a rig that ships under this name, else the path as it stands
// (whose loader then says what is wrong with it).
[[nodiscard]] std::filesystem::path ResolveRigPath(const std::string& argument);

// A rig by path, or by the name of one that ships ("cmu" or "cmu.json").
[[nodiscard]] Result<wrinkle::Rig> LoadRigArgument(const std::string& argument);

// A character package by path; empty: the default one. `rig`: as LoadRigArgument, empty: its own.
[[nodiscard]] Result<character::Character> LoadCharacterArgument(const std::string& glb,
                                                                 const std::string& rig);

}  // namespace furrow::cli
