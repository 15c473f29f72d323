// SPDX-License-Identifier: Apache-2.0
#include "base/data_dir.h"

#include <cstdlib>
#include <string>

namespace furrow {

Result<std::filesystem::path> FindDataFile(std::string_view name) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder;
  if (const char* set = std::getenv("FURROW_DATA_DIR"); set != nullptr && *set != '\0') {
    folder = set;
  } else {
    // bin/ and share/ are neighbours, in the build folder and after an installation.
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    folder = program.parent_path().parent_path() / "share" / "furrow";
  }
  const fs::path file = folder / name;
  if (fs::exists(file, error)) return file;
  return Status(StatusCode::kNotFound, "no such data file", file.string(),
                "build the target furrow_share, or set FURROW_DATA_DIR to a folder share/furrow");
}

}  // namespace furrow
