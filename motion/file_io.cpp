// SPDX-License-Identifier: Apache-2.0
#include "motion/file_io.h"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace furrow::motion {
namespace {

std::string ErrnoText(int error) { return std::generic_category().message(error); }

// All of `bytes` or an errno.
int WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// mkstemp makes files for the owner alone; a recording gets what the umask grants.
void ApplyUmask(int fd) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  (void)::fchmod(fd, 0666 & ~mask);
}

}  // namespace

Result<std::string> ReadFile(const std::filesystem::path& path, std::uint64_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return Status(StatusCode::kNotFound, "no such file", path.string());
  }
  if (!std::filesystem::is_regular_file(status)) {
    return Status(StatusCode::kIo, "not a regular file", path.string());
  }
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) return Status(StatusCode::kIo, error.message(), path.string());
  if (size > max_bytes) {
    return Status(StatusCode::kLimit,
                  "the file has " + std::to_string(size) + " bytes, the limit is " +
                      std::to_string(max_bytes),
                  path.string());
  }
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(size, '\0');
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return Status(StatusCode::kIo, "cannot be read", path.string());
  }
  return bytes;
}

Status WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes) {
  std::string temporary = path.string() + ".XXXXXX";
  const int fd = ::mkstemp(temporary.data());
  if (fd < 0) {
    return {StatusCode::kIo, "cannot be created: " + ErrnoText(errno), path.string()};
  }
  ApplyUmask(fd);
  int error = WriteAll(fd, bytes);
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return {StatusCode::kIo, "cannot be written: " + ErrnoText(error), path.string()};
  }
  return {};
}

}  // namespace furrow::motion
