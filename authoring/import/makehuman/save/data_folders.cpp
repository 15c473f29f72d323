// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/data_folders.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "base/asset_path.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBaseMesh = "3dobjs/base.obj";

bool HasBase(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kBaseMesh, error);
}

// Searches `folder` and FURROW_ASSET_PATH; empty if neither has the base mesh.
fs::path SearchBase(const fs::path& folder) {
  for (const char* prefix : {"", "data/", "makehuman/"}) {
    const Result<fs::path> found = FindAsset(std::string(prefix) + kBaseMesh, folder);
    if (found.ok()) return found->parent_path().parent_path();
  }
  return {};
}

}  // namespace

Result<DataFolders> FindDataFolders(const fs::path& mhm, std::span<const fs::path> given) {
  DataFolders folders;
  std::error_code error;
  for (const fs::path& folder : given) {
    if (!fs::is_directory(folder, error))
      return Status(StatusCode::kNotFound, "is not a folder", folder.string());
    if (folders.base.empty() && HasBase(folder)) {
      folders.base = folder;
    } else {
      folders.assets.push_back(folder);
    }
  }
  const fs::path here = fs::absolute(mhm, error).lexically_normal().parent_path();
  for (const fs::path& folder : {here, here.parent_path()}) {
    if (folders.base.empty()) folders.base = SearchBase(folder);
  }
  if (folders.base.empty())
    return Status(StatusCode::kNotFound, "no data folder of MakeHuman found", mhm.string(),
                  "state the folder that has 3dobjs/base.obj with --data");
  const fs::path of_user = here.parent_path() / "data";
  if (fs::is_directory(of_user, error) && !fs::equivalent(of_user, folders.base, error))
    folders.assets.push_back(of_user);
  return folders;
}

}  // namespace furrow::authoring
