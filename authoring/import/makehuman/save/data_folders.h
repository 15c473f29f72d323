// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// The data folders of MakeHuman that a save refers to.
struct DataFolders {
  std::filesystem::path base;                 // has 3dobjs/base.obj
  std::vector<std::filesystem::path> assets;  // further folders with parts and materials
};

// Finds the data folders of the save `mhm`. `given`: those that the user states, the most important
// first; each must exist. If none of them has the base mesh, the folder of the save is searched,
// then its parent (each also for a subfolder "data" or "makehuman"), then the folders of
// FURROW_ASSET_PATH likewise. MakeHuman keeps saves in "models" and its user's assets in "data"
// beside that; this "data" becomes one of `assets` if it exists.
//
// Errors: kNotFound (a given folder does not exist; no folder has the base mesh).
[[nodiscard]] Result<DataFolders> FindDataFolders(const std::filesystem::path& mhm,
                                                  std::span<const std::filesystem::path> given);

}  // namespace furrow::authoring
