// SPDX-License-Identifier: Apache-2.0
#include "motion/find_recording.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/data_dir.h"
#include "base/joined.h"

namespace furrow::motion {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFolder = "recordings";
constexpr std::string_view kExtension = ".bvh";  // of the shipped recordings

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == kExtension) names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace

Result<fs::path> FindRecording(const std::string& name_or_path) {
  std::error_code error;
  const std::size_t hash = name_or_path.find('#');
  const std::string name = name_or_path.substr(0, hash);
  const std::string rest = hash == std::string::npos ? "" : name_or_path.substr(hash);
  if (fs::exists(name_or_path, error) || fs::exists(name, error) || name.find('/') != name.npos) {
    return fs::path(name_or_path);
  }
  const auto folder = FindDataFile(kFolder);
  const std::string looked = "looked in " + fs::current_path(error).string() + " and in ";
  if (!folder.ok()) {
    return Status(StatusCode::kNotFound, "no such recording", name,
                  looked + folder.status().where() + ", which is missing");
  }
  const std::string file = name + (name.ends_with(kExtension) ? "" : std::string(kExtension));
  if (fs::path shipped = *folder / file; !name.empty() && fs::exists(shipped, error)) {
    return fs::path(shipped.string() + rest);
  }
  return Status(StatusCode::kNotFound, "no such recording", name,
                looked + folder->string() + "; shipped recordings: " + Joined(NamesIn(*folder)));
}

}  // namespace furrow::motion
