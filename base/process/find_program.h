// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"

namespace furrow {

// The path of helper program `program` for an executable in `folder`: beside it, else in
// ../libexec/furrow. kNotFound says what to build or install.
[[nodiscard]] Result<std::filesystem::path> FindHelperProgram(const std::string& program,
                                                              const std::filesystem::path& folder);

// The same for the running program.
[[nodiscard]] Result<std::filesystem::path> FindHelperProgram(const std::string& program);

}  // namespace furrow
