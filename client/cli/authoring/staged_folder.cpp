// SPDX-License-Identifier: Apache-2.0
#include "client/cli/authoring/staged_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "base/files.h"
#include "base/status.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

Status CannotWrite(const fs::path& path, const std::string& why) {
  return {StatusCode::kIo, "cannot write: " + why, path.string()};
}

constexpr char kAside[] = ".replaced";  // inside the temporary folder, so removed with it

// Moves files into a folder one by one and keeps the replaced files aside. The destructor restores
// them unless Keep() was called.
class Replacement {
 public:
  Replacement(const fs::path& target, fs::path aside) : target_(target), aside_(std::move(aside)) {}
  ~Replacement() {
    std::error_code ignored;
    // In reverse order. Errors are ignored: there is nothing better to do than to restore the rest.
    for (auto done = done_.rbegin(); done != done_.rend(); ++done) {
      if (done->is_new) {
        fs::remove(target_ / done->name, ignored);
      } else {
        fs::rename(aside_ / done->name, target_ / done->name, ignored);
      }
    }
  }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  Status Put(const fs::path& from, const fs::path& name) {
    const fs::path to = target_ / name;
    std::error_code error;
    fs::create_directories(to.parent_path(), error);
    if (error) return CannotWrite(to.parent_path(), error.message());
    const bool is_new = !fs::exists(fs::symlink_status(to, error));
    if (!is_new) {
      if (fs::is_directory(to, error)) return CannotWrite(to, "a folder of this name exists");
      fs::create_directories((aside_ / name).parent_path(), error);
      if (!error) fs::rename(to, aside_ / name, error);
      if (error) return CannotWrite(to, error.message());
    }
    // Noted before the file moves, so that a failure of the move is undone, too.
    done_.push_back({name, is_new});
    fs::rename(from, to, error);
    return error ? CannotWrite(to, error.message()) : Status();
  }
  void Keep() { done_.clear(); }

 private:
  struct Done {
    fs::path name;
    bool is_new;
  };
  const fs::path& target_;
  fs::path aside_;
  std::vector<Done> done_;
};

}  // namespace

Result<StagedFolder> StagedFolder::Create(const fs::path& target) {
  // "out/" names the folder "out".
  fs::path folder = fs::absolute(target).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    return CannotWrite(folder, "it exists and is not a folder");
  }
  fs::create_directories(folder.parent_path(), error);
  if (error) return CannotWrite(folder.parent_path(), error.message());
  // Beside the target and not in /tmp, because rename() works within one file system only.
  std::string staging =
      (folder.parent_path() / ("." + folder.filename().string() + ".XXXXXX")).string();
  if (mkdtemp(staging.data()) == nullptr) return CannotWrite(folder, std::strerror(errno));
  const mode_t mask = umask(0);  // mkdtemp() creates a private folder; apply the usual mode
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
  if (error) return CannotWrite(path.parent_path(), error.message());
  return WriteFileAtomically(path, bytes);
}

Status StagedFolder::Commit() {
  std::error_code error;
  // One rename replaces everything at once. It fails if the folder has files, which then stay
  // beside the new ones.
  fs::rename(staging_, target_, error);  // also replaces an empty folder
  if (!error) {
    staging_.clear();
    return {};
  }
  if (!fs::is_directory(target_)) return CannotWrite(target_, error.message());
  std::vector<fs::path> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(staging_)) {
    if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(staging_));
  }
  Replacement replacement(target_, staging_ / kAside);
  for (const fs::path& name : names) {
    FURROW_RETURN_IF_ERROR(replacement.Put(staging_ / name, name));
  }
  replacement.Keep();
  return {};
}

}  // namespace furrow::cli
