// SPDX-License-Identifier: Apache-2.0
#include "base/data_dir.h"

#include <cstdlib>
#include <string>

namespace furrow {

std::filesystem::path InstallPrefix(const std::filesystem::path& folder) {
  const std::filesystem::path above = folder.parent_path();
  const bool helper = folder.filename() == "furrow" && above.filename() == "libexec";
  return helper ? above.parent_path() : above;
}

std::filesystem::path InstallPrefix() {
  std::error_code error;
  // Not argv[0], which the caller chooses and which may be a name on the PATH.
  return InstallPrefix(std::filesystem::read_symlink("/proc/self/exe", error).parent_path());
}

Result<std::filesystem::path> FindDataFile(std::string_view name) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder;
  if (const char* set = std::getenv("FURROW_DATA_DIR"); set != nullptr && *set != '\0') {
    folder = set;
  } else {
    folder = InstallPrefix() / "share" / "furrow";
  }
  const fs::path file = folder / name;
  if (fs::exists(file, error)) return file;
  return Status(StatusCode::kNotFound, "no such data file", file.string(),
                "build the target furrow_share, or set FURROW_DATA_DIR to a folder share/furrow");
}

}  // namespace furrow
