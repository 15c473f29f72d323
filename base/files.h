// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow {

// Size limit for text files whose format states none (OBJ, BVH, name maps): far above real files.
inline constexpr std::uint64_t kMaxTextFileBytes = std::uint64_t{256} << 20;

// Reads a whole regular file.
//
// Errors, with the path as `where`: kNotFound, kInvalidArgument (NotAFile()), kIo, kLimit (larger
// than `max_bytes`), kUnsupported (what Git LFS leaves in place of a large file).
[[nodiscard]] Result<std::string> ReadFile(const std::filesystem::path& path,
                                           std::uint64_t max_bytes);

// The failure to read a folder, a device or a pipe as a file. Code: kInvalidArgument, because it is
// bad input, which has an exit code of its own.
[[nodiscard]] Status NotAFile(const std::filesystem::path& path, bool is_folder);

// True if `text` is what Git LFS leaves in place of a large file that was not downloaded.
[[nodiscard]] bool IsGitLfsPointer(std::string_view text);

// Replaces the content of the file `path` by `bytes` in one step: writes a temporary file beside
// it, flushes that to disk and renames it. A reader sees the old file or the new one, never a part
// of either. After an error (kIo) the old file is unchanged and no temporary file is left.
//
// A symbolic link is followed. A device or pipe is written to directly, because a rename would
// replace it.
//
// Flush::kNone leaves the flush to the operating system, for files that are cheap to make again,
// such as the pictures of a live stream.
enum class Flush { kDisk, kNone };
[[nodiscard]] Status WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes,
                                         Flush flush = Flush::kDisk);

// An argument of WriteFilesAtomically(). The caller owns `bytes`. A new secret file can be read by
// its owner alone (mode 0600); other files get the usual mode.
struct FileToWrite {
  std::filesystem::path path;
  std::string_view bytes;
  bool is_secret = false;
};

// Replaces several files as WriteFileAtomically() does one. All temporary files are complete before
// the first rename, so a full disk replaces none of the files. Error: kIo.
[[nodiscard]] Status WriteFilesAtomically(std::span<const FileToWrite> files,
                                          Flush flush = Flush::kDisk);

// Reads a key or a password. Errors: as ReadFile(), and kInvalidArgument if others than the owner
// have rights on the file, unless root hands it to a group of this program (0440), as systemd does.
[[nodiscard]] Result<std::string> ReadSecretFile(const std::filesystem::path& path,
                                                 std::uint64_t max_bytes);

// Replaces a file as WriteFileAtomically() does, so that only its owner can read it.
[[nodiscard]] Status WriteSecretFile(const std::filesystem::path& path, std::string_view bytes);

// Checks that `path` can be written, before work that takes long. The file stays as it is. Error:
// kIo, with the path as `where` and the reason.
[[nodiscard]] Status CheckWritable(const std::filesystem::path& path);

}  // namespace furrow
