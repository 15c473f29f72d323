// SPDX-License-Identifier: Apache-2.0
#include "client/cli/file_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "client/cli/exit_code.h"

namespace furrow::cli {

Status WriteFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return {StatusCode::kIo, "cannot write the file", path.string(), "is the disk full?"};
  return {};
}

Status CheckWritable(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_there = std::filesystem::exists(path, ignored);
  errno = 0;
  const bool opened = std::ofstream(path, std::ios::binary | std::ios::app).is_open();
  if (!opened) return {StatusCode::kIo, std::strerror(errno), path.string(), "cannot be written"};
  if (!is_there) std::filesystem::remove(path, ignored);
  return {};
}

Status WriteStandardOutput(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
      std::fflush(stdout) == 0) {
    return {};
  }
  return {StatusCode::kIo, std::strerror(errno), "standard output"};
}

int StandardOutputFailed() {
  if (errno == EPIPE) return kDone;
  return Fail({StatusCode::kIo, std::strerror(errno), "standard output"});
}

}  // namespace furrow::cli
