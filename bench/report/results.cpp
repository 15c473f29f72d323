// SPDX-License-Identifier: Apache-2.0
#include "bench/report/results.h"

#include <fstream>
#include <system_error>

#include "bench/report/value_or_exit.h"

namespace furrow::bench {

void MakeResultFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    FailWith({StatusCode::kIo, "cannot create the folder: " + error.message(), folder.string()});
}

void WriteResult(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (!(file << text << std::flush)) {
    FailWith({StatusCode::kIo, "cannot write the file", path.string()});
  }
}

}  // namespace furrow::bench
