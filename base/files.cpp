// SPDX-License-Identifier: Apache-2.0
#include "base/files.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace furrow {
namespace {

namespace fs = std::filesystem;

Status SystemError(std::string what, const fs::path& path, int error) {
  return {StatusCode::kIo, std::move(what) + ": " + std::generic_category().message(error),
          path.string()};
}

// Writes all of `bytes`. Returns 0 or an errno.
int WriteAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// mkstemp() creates files that only their owner can read; output files get the usual mode.
int ApplyUmask(int descriptor) {
  // umask() can only be read by setting it.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return ::fchmod(descriptor, 0666 & ~mask) == 0 ? 0 : errno;
}

bool IsDeviceOrPipe(const fs::path& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  return type == fs::file_type::character || type == fs::file_type::fifo ||
         type == fs::file_type::block || type == fs::file_type::socket;
}

// One file on its way to the disk. The destructor removes the temporary file unless Publish()
// moved it into place.
class PendingFile {
 public:
  PendingFile() = default;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  Status Write(const FileToWrite& file, Flush flush) {
    std::error_code ignored;
    if (fs::is_directory(file.path, ignored)) {
      return {StatusCode::kIo, "cannot write: the path is a folder", file.path.string()};
    }
    // A rename would replace the device or pipe by a file: `--out /dev/stdout` must stay usable.
    if (IsDeviceOrPipe(file.path)) return WriteInPlace(file);
    // A rename onto a symbolic link would replace the link, so the file behind it is replaced.
    target_ =
        fs::is_symlink(file.path, ignored) ? fs::weakly_canonical(file.path, ignored) : fs::path();
    if (target_.empty()) target_ = file.path;
    // In the same folder as the target: a rename across file systems is impossible.
    std::string name = target_.string() + ".XXXXXX";
    const int descriptor = ::mkstemp(name.data());
    if (descriptor < 0) return SystemError("cannot create a file there", file.path, errno);
    temporary_ = std::move(name);
    int error = file.is_secret ? 0 : ApplyUmask(descriptor);
    // Keeps the first error. close() runs in any case, and reports late write errors (NFS, quotas).
    if (error == 0) error = WriteAll(descriptor, file.bytes);
    if (error == 0 && flush == Flush::kDisk && ::fsync(descriptor) != 0) error = errno;
    if (::close(descriptor) != 0 && error == 0) error = errno;
    return error == 0 ? Status() : SystemError("cannot write", file.path, error);
  }

  Status Publish() {
    if (temporary_.empty()) return {};
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      return SystemError("cannot write", target_, errno);
    }
    temporary_.clear();
    return {};
  }

 private:
  static Status WriteInPlace(const FileToWrite& file) {
    const int descriptor = ::open(file.path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return SystemError("cannot open", file.path, errno);
    int error = WriteAll(descriptor, file.bytes);
    if (::close(descriptor) != 0 && error == 0) error = errno;
    return error == 0 ? Status() : SystemError("cannot write", file.path, error);
  }

  std::string temporary_;
  fs::path target_;
};

}  // namespace

Result<std::string> ReadFile(const fs::path& path, std::uint64_t max_bytes) {
  std::error_code error;
  // Opening a pipe or device could block forever, so the kind is checked before.
  const fs::file_status kind = fs::status(path, error);
  if (kind.type() == fs::file_type::not_found) {
    return Status(StatusCode::kNotFound, "no such file", path.string());
  }
  if (error) return Status(StatusCode::kIo, error.message(), path.string());
  if (kind.type() != fs::file_type::regular) {
    return NotAFile(path, kind.type() == fs::file_type::directory);
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return Status(StatusCode::kIo, error.message(), path.string());
  if (size > max_bytes) {
    return Status(StatusCode::kLimit,
                  "the file has " + std::to_string(size) + " bytes; the limit is " +
                      std::to_string(max_bytes),
                  path.string());
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return SystemError("cannot open", path, errno);
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    return Status(StatusCode::kIo, "the file became shorter while it was read", path.string());
  }
  if (IsGitLfsPointer(bytes)) {
    return Status(StatusCode::kUnsupported, "the file is a Git LFS pointer, not the file itself",
                  path.string(), "run 'git lfs pull' in its folder");
  }
  return bytes;
}

Status NotAFile(const fs::path& path, bool is_folder) {
  // Not kIo: the caller named the wrong thing, and the operating system did not fail.
  if (is_folder) {
    return {StatusCode::kInvalidArgument, "is a folder", path.string(), "name a file in it"};
  }
  return {StatusCode::kInvalidArgument, "not a regular file", path.string()};
}

bool IsGitLfsPointer(std::string_view text) {
  return text.starts_with("version https://git-lfs.github.com/");
}

Status WriteFileAtomically(const fs::path& path, std::string_view bytes, Flush flush) {
  const FileToWrite file{path, bytes};
  return WriteFilesAtomically({&file, 1}, flush);
}

Status WriteFilesAtomically(std::span<const FileToWrite> files, Flush flush) {
  // All files are written before the first is renamed, so that a full disk changes none of them.
  std::vector<PendingFile> pending(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    FURROW_RETURN_IF_ERROR(pending[i].Write(files[i], flush));
  }
  for (PendingFile& file : pending) FURROW_RETURN_IF_ERROR(file.Publish());
  return {};
}

Result<std::string> ReadSecretFile(const fs::path& path, std::uint64_t max_bytes) {
  struct stat status = {};
  const bool is_file = ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  // The supervisor's way to hand a secret to a program without privileges.
  const bool is_handed_over = status.st_uid == 0 && ::geteuid() != 0;
  const mode_t forbidden = S_IRWXG | S_IRWXO;
  if (is_file && (status.st_mode & (is_handed_over ? forbidden & ~S_IRGRP : forbidden)) != 0) {
    return Status(StatusCode::kInvalidArgument,
                  "other users have rights on this file, which holds a secret", path.string(),
                  "run: chmod 600 " + path.string());
  }
  return ReadFile(path, max_bytes);
}

Status WriteSecretFile(const fs::path& path, std::string_view bytes) {
  const FileToWrite file{path, bytes, /*is_secret=*/true};
  return WriteFilesAtomically({&file, 1});
}

Status CheckWritable(const fs::path& path) {
  if (IsDeviceOrPipe(path)) {
    return ::access(path.c_str(), W_OK) == 0 ? Status() : SystemError("cannot write", path, errno);
  }
  // Atomic writing needs the right to create a file in the folder, not the right to write the file.
  PendingFile unpublished;
  return unpublished.Write({path, {}}, Flush::kNone);
}

}  // namespace furrow
