// SPDX-License-Identifier: Apache-2.0
#include "rig/shipped_maps.h"

#include <algorithm>

#include "base/data_dir.h"
#include "base/text.h"
#include "base/joined.h"

namespace furrow::rig {

Result<std::vector<std::filesystem::path>> ListShippedMaps(const std::string& folder) {
  const auto shipped = FindDataFile(folder);
  FURROW_RETURN_IF_ERROR(shipped);
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(*shipped, error)) {
    if (file.path().extension() == ".json") files.push_back(file.path());
  }
  if (error) return Status(StatusCode::kIo, error.message(), shipped->string());
  // Directories list files in any order; the first error must not depend on it.
  std::ranges::sort(files);
  return files;
}

Result<std::filesystem::path> FindMap(const std::string& folder, const std::string& name_or_file) {
  std::error_code error;
  // A slash marks a path, so a missing file is not mistaken for the name of a shipped map.
  if (std::filesystem::is_regular_file(name_or_file, error) ||
      name_or_file.find('/') != std::string::npos) {
    return std::filesystem::path(name_or_file);
  }
  auto shipped = FindDataFile(folder + "/" + name_or_file + ".json");
  return shipped.ok() ? shipped : NotShipped("map", folder, name_or_file);
}

Status NotShipped(const std::string& kind, const std::string& folder, const std::string& name) {
  const auto files = ListShippedMaps(folder);
  if (!files.ok()) return Status(StatusCode::kNotFound, "no such file", name);
  std::vector<std::string> names;
  for (const auto& file : *files) {
    // "default.strokes.json" belongs to the rig "default".
    if (!file.stem().has_extension()) names.push_back(file.stem().string());
  }
  const std::string meant = DidYouMean(name, names);
  return Status(StatusCode::kNotFound, "no such file, and no shipped " + kind + " of this name",
                name,
                (meant.empty() ? "" : meant + " ") + "shipped " + kind + "s: " + Joined(names));
}

}  // namespace furrow::rig
