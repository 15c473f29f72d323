// SPDX-License-Identifier: Apache-2.0
#include "base/asset_path.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

namespace furrow {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameBytes = 1024;

// The folders to search, in order: beside the rig first, so that a local file wins.
std::vector<fs::path> AssetFolders(const fs::path& folder) {
  std::vector<fs::path> folders = {folder.empty() ? fs::path(".") : folder};
  const char* variable = std::getenv("FURROW_ASSET_PATH");
  if (variable != nullptr) AppendPaths(variable, &folders);
  return folders;
}

}  // namespace

void AppendPaths(std::string_view list, std::vector<fs::path>* paths) {
  while (!list.empty()) {
    const std::size_t colon = std::min(list.find(':'), list.size());
    if (colon > 0) paths->emplace_back(list.substr(0, colon));
    list.remove_prefix(std::min(colon + 1, list.size()));
  }
}

// Names come from rigs of strangers. They must not reach a file outside the search folders, so
// absolute paths, "..", drive letters and backslashes are refused on every system.
Status CheckAssetName(std::string_view name) {
  const auto refuse = [&](const char* why) {
    return Status(StatusCode::kInvalidArgument, "file name '" + std::string(name) + "' " + why, {},
                  "name a file beside the rig or in a folder of FURROW_ASSET_PATH");
  };
  if (name.empty()) return refuse("is empty");
  if (name.size() > kMaxNameBytes) {
    return {StatusCode::kLimit, "a file name has " + std::to_string(name.size()) +
                                    " bytes; at most " + std::to_string(kMaxNameBytes) +
                                    " are accepted"};
  }
  if (name.front() == '/') return refuse("is absolute");
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      return {StatusCode::kInvalidArgument, "a file name holds a control byte"};
    }
    if (c == '\\' || c == ':') return refuse("holds a backslash or a colon");
  }
  for (const fs::path& part : fs::path(name)) {
    if (part == "..") return refuse("holds '..'");
  }
  return {};
}

Result<fs::path> FindAsset(std::string_view name, const fs::path& folder) {
  // Here as well: the glTF reader passes URIs that no rig check has seen.
  FURROW_RETURN_IF_ERROR(CheckAssetName(name));
  std::string tried;
  for (const fs::path& candidate : AssetFolders(folder)) {
    const fs::path path = candidate / name;
    std::error_code error;
    if (fs::is_regular_file(path, error)) return path;
    tried += (tried.empty() ? "" : ", ") + candidate.string();
  }
  return Status(StatusCode::kNotFound, "no file '" + std::string(name) + "' in " + tried, {},
                "put it into that folder, or add its folder to FURROW_ASSET_PATH");
}

}  // namespace furrow
