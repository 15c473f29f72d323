// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::cli {

// An output folder that receives all of its files or none. Files are written to a temporary folder
// beside it and moved by Commit(). The destructor removes files that were not committed.
class StagedFolder {
 public:
  // Creates the temporary folder and the parents of `target`, so that an unwritable place is
  // reported before the work starts. Errors: kIo, with the path.
  [[nodiscard]] static Result<StagedFolder> Create(const std::filesystem::path& target);
  ~StagedFolder();
  StagedFolder(StagedFolder&& other) noexcept;
  StagedFolder& operator=(StagedFolder&&) = delete;

  // Writes a file to the temporary folder. `name` may contain folders: "report/squash_lit.png".
  // Errors: kIo.
  [[nodiscard]] Status Write(const std::string& name, std::string_view bytes);
  // Moves all files into `target`, in one step if it is missing or empty, otherwise file by file.
  // Files of the same name are replaced; other files stay. An error leaves `target` unchanged. Only
  // a process that is killed between two files leaves a mixture of old and new files.
  [[nodiscard]] Status Commit();

 private:
  StagedFolder(std::filesystem::path target, std::filesystem::path staging);
  std::filesystem::path target_;
  std::filesystem::path staging_;
};

}  // namespace furrow::cli
