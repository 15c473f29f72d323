// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::cli {

// An output folder that shows all of its files or none: they are written to a temporary folder
// beside it and moved in at the end. Whatever is not committed is removed with the object.
class StagedFolder {
 public:
  // Makes the temporary folder (and the parents of `target`), so that an unwritable place is known
  // before the work begins. kIo names the place.
  [[nodiscard]] static Result<StagedFolder> Create(const std::filesystem::path& target);
  ~StagedFolder();
  StagedFolder(StagedFolder&& other) noexcept;
  StagedFolder& operator=(StagedFolder&&) = delete;

  // `name` may hold folders: "report/squash_lit.png".
  [[nodiscard]] Status Write(const std::string& name, std::string_view bytes);
  // Moves all into `target`: in one step where it is not there yet or is empty, else file by file,
  // in place of files of the same name. Other files in it stay. An error leaves `target` as it was;
  // only a process that is killed between two files leaves some old and some new.
  [[nodiscard]] Status Commit();

 private:
  StagedFolder(std::filesystem::path target, std::filesystem::path staging);
  std::filesystem::path target_;
  std::filesystem::path staging_;
};

}  // namespace furrow::cli
