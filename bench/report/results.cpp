// SPDX-License-Identifier: Apache-2.0
#include "bench/report/results.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace furrow::bench {

void MakeResultFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  std::fprintf(stderr, "cannot make the folder %s: %s\n", folder.c_str(), error.message().c_str());
  std::exit(1);
}

void WriteResult(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file << text << std::flush) return;
  std::fprintf(stderr, "cannot write %s\n", path.c_str());
  std::exit(1);
}

}  // namespace furrow::bench
