// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace furrow::bench {

// Write the results of a benchmark. On failure, both exit the program with status 1 and one message
// on stderr.
void MakeResultFolder(const std::filesystem::path& folder);
void WriteResult(const std::filesystem::path& path, const std::string& text);

}  // namespace furrow::bench
