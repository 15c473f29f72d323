// SPDX-License-Identifier: Apache-2.0
#include "server/machine/cache_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

namespace furrow::server {
namespace {

namespace fs = std::filesystem;

// Empty if the variable is not an absolute path; relative ones depend on where a program starts.
fs::path FolderIn(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return {};
  const std::string first(text, std::strcspn(text, ":"));
  const fs::path path(first);
  return path.is_absolute() ? path : fs::path();
}

void SetIfUnset(const char* variable, const std::string& value) {
  setenv(variable, value.c_str(), /*overwrite=*/0);
}

}  // namespace

fs::path CacheFolder() {
  if (fs::path folder = FolderIn("CACHE_DIRECTORY"); !folder.empty()) {
    // systemd's, which is a link if the user of the service is a dynamic one.
    std::error_code error;
    fs::path real = fs::canonical(folder, error);
    return error ? folder : real;
  }
  if (const fs::path folder = FolderIn("XDG_CACHE_HOME"); !folder.empty()) {
    return folder / "furrow";
  }
  const fs::path home = FolderIn("HOME");
  return home.empty() ? fs::path() : home / ".cache" / "furrow";
}

Status PrepareCacheFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder.parent_path(), error);
  // Not create_directories(): nobody else may enter between its creation and a change of its mode.
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    return {StatusCode::kIo, std::string("cannot be created: ") + std::strerror(errno),
            folder.string()};
  }
  struct stat found {};
  if (lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode)) {
    return {StatusCode::kInvalidArgument, "is not a folder", folder.string()};
  }
  if (found.st_uid != geteuid() || (found.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    return {StatusCode::kInvalidArgument, "others may write to it", folder.string(),
            "give it to the user of furrowd, with mode 700"};
  }
  return {};
}

void LetDriversCache(const fs::path& folder) {
  const std::string size = std::to_string(kMaxShaderMegabytes);
  SetIfUnset("MESA_SHADER_CACHE_DIR", (folder / "mesa").string());
  SetIfUnset("MESA_SHADER_CACHE_MAX_SIZE", size + "M");
  SetIfUnset("__GL_SHADER_DISK_CACHE_PATH", (folder / "nvidia").string());
  SetIfUnset("__GL_SHADER_DISK_CACHE_SIZE", size + "000000");
  // NVIDIA's driver does not create its folder.
  std::error_code ignored;
  fs::create_directory(folder / "nvidia", ignored);
}

}  // namespace furrow::server
