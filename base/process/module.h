// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace furrow {

// Where a module of this installation lies: lib/furrow/NAME in InstallPrefix().
[[nodiscard]] std::filesystem::path ModulePath(const std::string& name);

// Loads a module, which stays loaded until the process ends, and finds a function in it. Null on
// failure; then `why` is the reason that the system gives, or empty if it gives none.
[[nodiscard]] void* LoadFromModule(const std::filesystem::path& module, const char* function,
                                   std::string* why);

}  // namespace furrow
