// SPDX-License-Identifier: Apache-2.0
#include "client/cli/staged_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "client/cli/file_output.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

Status Refused(const fs::path& path, const std::string& why) {
  return {StatusCode::kIo, "cannot write: " + why, path.string()};
}

}  // namespace

Result<StagedFolder> StagedFolder::Create(const fs::path& target) {
  // "out/" names the folder "out".
  fs::path folder = fs::absolute(target).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    return Refused(folder, "it is there, and no folder");
  }
  fs::create_directories(folder.parent_path(), error);
  if (error) return Refused(folder.parent_path(), error.message());
  std::string staging =
      (folder.parent_path() / ("." + folder.filename().string() + ".XXXXXX")).string();
  if (mkdtemp(staging.data()) == nullptr) return Refused(folder, std::strerror(errno));
  const mode_t mask = umask(0);  // mkdtemp() makes it private; a folder of results is not
  umask(mask);
  fs::permissions(staging, static_cast<fs::perms>(0777 & ~mask), error);
  return StagedFolder(std::move(folder), staging);
}

StagedFolder::StagedFolder(fs::path target, fs::path staging)
    : target_(std::move(target)), staging_(std::move(staging)) {}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept
    : target_(std::move(other.target_)), staging_(std::exchange(other.staging_, {})) {}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
}

Status StagedFolder::Write(const std::string& name, std::string_view bytes) {
  const fs::path path = staging_ / name;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return Refused(path.parent_path(), error.message());
  return WriteFile(path, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

Status StagedFolder::Commit() {
  std::error_code error;
  fs::rename(staging_, target_, error);  // replaces an empty folder, too
  if (!error) {
    staging_.clear();
    return {};
  }
  if (!fs::is_directory(target_)) return Refused(target_, error.message());
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(staging_)) {
    if (!entry.is_directory()) files.push_back(entry.path());
  }
  for (const fs::path& file : files) {
    const fs::path to = target_ / file.lexically_relative(staging_);
    fs::create_directories(to.parent_path(), error);
    if (!error) fs::rename(file, to, error);
    if (error) return Refused(to, error.message());
  }
  return {};
}

}  // namespace furrow::cli
