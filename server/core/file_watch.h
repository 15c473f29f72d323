// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

namespace furrow::server {

// Notices that a file was written or replaced, when it is asked.
class FileWatch {
 public:
  // An empty path never changes.
  explicit FileWatch(std::filesystem::path path) : path_(std::move(path)) {}

  // True if the file is another one than at the last call. An absent file does not count: a program
  // may be replacing it. Compares time, size and place in the file system.
  [[nodiscard]] bool Changed();

 private:
  struct Mark {
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    std::int64_t size = -1;
    std::uint64_t inode = 0;
    friend bool operator==(const Mark&, const Mark&) = default;
  };
  std::filesystem::path path_;
  Mark last_;
};

}  // namespace furrow::server
