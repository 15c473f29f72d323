// SPDX-License-Identifier: Apache-2.0
#include "rig/shipped_maps.h"

#include "base/data_dir.h"

namespace furrow::rig {

Result<std::filesystem::path> FindMap(const std::string& folder, const std::string& name_or_file) {
  std::error_code error;
  // A slash marks a path, so a missing file is not mistaken for the name of a shipped map.
  if (std::filesystem::is_regular_file(name_or_file, error) ||
      name_or_file.find('/') != std::string::npos) {
    return std::filesystem::path(name_or_file);
  }
  auto shipped = FindDataFile(folder + "/" + name_or_file + ".json");
  return shipped.ok() ? shipped : NotShipped("map", folder, ".json", name_or_file);
}

}  // namespace furrow::rig
