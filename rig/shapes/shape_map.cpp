// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_map.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/data_dir.h"
#include "base/files.h"
#include "base/status.h"
#include "rig/shipped_maps.h"

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
  const auto files = ListDataFiles(kShapeMapFolder, ".json");
  FURROW_RETURN_IF_ERROR(files);
  std::vector<ShapeMap> maps;
  for (const fs::path& file : *files) {
    auto map = LoadShapeMapFile(file);
    FURROW_RETURN_IF_ERROR(map);
    maps.push_back(*std::move(map));
  }
  // A tie between maps goes by their names, whatever their files are called.
  std::ranges::sort(maps, {}, &ShapeMap::name);
  return maps;
}

Result<ShapeMap> LoadShapeMap(const std::string& name_or_file) {
  const auto path = FindMap(kShapeMapFolder, name_or_file);
  FURROW_RETURN_IF_ERROR(path);
  return LoadShapeMapFile(*path);
}

}  // namespace furrow::rig
