// SPDX-License-Identifier: Apache-2.0
#include "base/process/find_program.h"

#include <system_error>

#include <unistd.h>

namespace furrow {

namespace fs = std::filesystem;

Result<fs::path> FindHelperProgram(const std::string& program, const fs::path& folder) {
  for (const fs::path& place : {folder, folder.parent_path() / "libexec" / "furrow"}) {
    if (access((place / program).c_str(), X_OK) == 0) return place / program;
  }
  return Status(StatusCode::kNotFound, "the program " + program + " is missing", folder.string(),
                "build it with 'cmake --build <build folder> --target furrow_programs', or "
                "install the package furrow-tools");
}

Result<fs::path> FindHelperProgram(const std::string& program) {
  std::error_code error;
  // Not argv[0], which the caller chooses and which may be a name on the PATH.
  return FindHelperProgram(program, fs::read_symlink("/proc/self/exe", error).parent_path());
}

}  // namespace furrow
