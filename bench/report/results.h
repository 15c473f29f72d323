// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace furrow::bench {

// Where a benchmark's results go. It has nothing to fall back on: what cannot be made or written
// ends the program with exit status 1 and one message on stderr.
void MakeResultFolder(const std::filesystem::path& folder);
void WriteResult(const std::filesystem::path& path, const std::string& text);

}  // namespace furrow::bench
