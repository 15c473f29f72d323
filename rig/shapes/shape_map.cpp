// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_map.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/data_dir.h"
#include "base/files.h"
#include "base/status.h"

namespace furrow::rig {
namespace {

namespace fs = std::filesystem;

constexpr char kShapeMapFolder[] = "shape_maps";

Result<ShapeMap> LoadShapeMapFile(const fs::path& path) {
  const auto text = ReadFile(path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseShapeMap(*text, path.string());
}

}  // namespace

int MapFormula::RenamedShape() const {
  const bool renames = sum.size() == 1 && sum[0].gain == 1.0f && sum[0].product.size() == 1 &&
                       !sum[0].product[0].rest;
  return renames ? sum[0].product[0].shape : -1;
}

Result<std::vector<ShapeMap>> LoadShippedShapeMaps() {
  const auto folder = FindDataFile(kShapeMapFolder);
  FURROW_RETURN_IF_ERROR(folder);
  std::vector<ShapeMap> maps;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(*folder, error)) {
    if (file.path().extension() != ".json") continue;
    auto map = LoadShapeMapFile(file.path());
    FURROW_RETURN_IF_ERROR(map);
    maps.push_back(*std::move(map));
  }
  if (error) return Status(StatusCode::kIo, error.message(), folder->string());
  // Directories list files in any order; a tie between maps must not depend on it.
  std::ranges::sort(maps, {}, &ShapeMap::name);
  return maps;
}

Result<ShapeMap> LoadShapeMap(const std::string& name_or_file) {
  std::error_code error;
  fs::path path = name_or_file;
  // A slash marks a path, so a missing file is not mistaken for the name of a shipped map.
  if (!fs::is_regular_file(path, error) && name_or_file.find('/') == std::string::npos) {
    const auto shipped = FindDataFile(std::string(kShapeMapFolder) + "/" + name_or_file + ".json");
    FURROW_RETURN_IF_ERROR(shipped);
    path = *shipped;
  }
  return LoadShapeMapFile(path);
}

}  // namespace furrow::rig
