// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"

namespace furrow::authoring {

// The same status with the path in front of its position: "face.glb: meshes[0]".
[[nodiscard]] inline Status InFile(const Status& status, const std::filesystem::path& path) {
  const std::string where = path.string() + (status.where().empty() ? "" : ": " + status.where());
  return {status.code(), status.what(), where, status.todo()};
}

}  // namespace furrow::authoring
