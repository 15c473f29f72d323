// SPDX-License-Identifier: Apache-2.0
#include "base/data_dir.h"

#include <algorithm>
#include <cstdlib>

#include "base/joined.h"
#include "base/text.h"

namespace furrow {

std::filesystem::path InstallPrefix(const std::filesystem::path& folder) {
  const std::filesystem::path above = folder.parent_path();
  const bool helper = folder.filename() == "furrow" && above.filename() == "libexec";
  return helper ? above.parent_path() : above;
}

std::filesystem::path InstallPrefix() {
  std::error_code error;
  // Not argv[0], which the caller chooses and which may be a name on the PATH.
  return InstallPrefix(std::filesystem::read_symlink("/proc/self/exe", error).parent_path());
}

Result<std::filesystem::path> FindDataFile(std::string_view name) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder;
  if (const char* set = std::getenv("FURROW_DATA_DIR"); set != nullptr && *set != '\0') {
    folder = set;
  } else {
    folder = InstallPrefix() / "share" / "furrow";
  }
  const fs::path file = folder / name;
  if (fs::exists(file, error)) return file;
  return Status(StatusCode::kNotFound, "no such data file", file.string(),
                "build the target furrow_share, or set FURROW_DATA_DIR to a folder share/furrow");
}

std::filesystem::path FileOrShipped(const std::string& name_or_file, std::string_view folder,
                                    std::string_view extension) {
  std::error_code error;
  // A slash says that a file is meant, so a misspelt path does not select a shipped one.
  if (name_or_file.find('/') != std::string::npos) return name_or_file;
  const std::filesystem::path file = name_or_file;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_directory(file, error)) {
    return file;
  }
  std::filesystem::path shipped = std::filesystem::path(folder) / name_or_file;
  if (!name_or_file.ends_with(extension)) shipped += extension;
  const auto found = FindDataFile(shipped.lexically_normal().string());
  return found.ok() ? *found : file;
}

Result<std::vector<std::filesystem::path>> ListDataFiles(std::string_view folder,
                                                         std::string_view extension) {
  const auto shipped = FindDataFile(folder);
  FURROW_RETURN_IF_ERROR(shipped);
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(*shipped, error)) {
    if (file.path().extension().string() == extension) files.push_back(file.path());
  }
  if (error) return Status(StatusCode::kIo, error.message(), shipped->string());
  // Directories list files in any order; the first error must not depend on it.
  std::ranges::sort(files);
  return files;
}

Status NotShipped(const std::string& kind, std::string_view folder, std::string_view extension,
                  const std::string& name) {
  const auto files = ListDataFiles(folder, extension);
  if (!files.ok()) return Status(StatusCode::kNotFound, "no such file", name);
  std::vector<std::string> names;
  for (const auto& file : *files) {
    // "default.strokes.json" belongs to the rig "default", "elder.web.glb" to a character.
    if (!file.stem().has_extension()) names.push_back(file.stem().string());
  }
  const std::string meant = DidYouMean(name, names);
  return Status(StatusCode::kNotFound, "no such file, and no shipped " + kind + " of this name",
                name,
                (meant.empty() ? "" : meant + " ") + "shipped " + kind + "s: " + Joined(names));
}

}  // namespace furrow
