// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/target_store.h"

#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/ascii.h"
#include "base/files.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTargets = 50'000;
constexpr int kMaxDepth = 12;
constexpr const char* kArchive = "targets.npz";
// Names in the archive: "targets/nose/nose-hump-incr.index.npy".
constexpr std::string_view kFolder = "targets/";
constexpr std::string_view kIndex = ".index.npy";
constexpr std::string_view kVector = ".vector.npy";
constexpr std::string_view kExtension = ".target";

// The name in the archive without its last part.
std::string PackedName(const fs::path& target) {
  fs::path name = target;
  return std::string(kFolder) + name.replace_extension().generic_string();
}

}  // namespace

Result<TargetStore> TargetStore::Open(const fs::path& folder) {
  TargetStore store;
  store.targets_ = folder / "targets";
  FURROW_RETURN_IF_ERROR(store.ListFiles());
  std::error_code error;
  if (fs::exists(folder / kArchive, error))
    FURROW_RETURN_IF_ERROR(store.OpenArchive(folder / kArchive));
  if (store.files_.size() + store.packed_.size() > kMaxTargets)
    return Status(StatusCode::kLimit, "the folder has more than 50000 targets", folder.string());
  std::set<fs::path> all = store.files_;
  all.insert(store.packed_.begin(), store.packed_.end());
  if (all.empty())
    return Status(StatusCode::kNotFound, "contains no targets", store.targets_.string(),
                  "use the data folder of an installed MakeHuman (with targets.npz) or of its "
                  "source, makehumancommunity/makehuman on GitHub");
  for (const fs::path& target : all) store.library_.Add(target);
  return store;
}

Status TargetStore::ListFiles() {
  std::error_code error;
  if (!fs::is_directory(targets_, error)) return {};
  fs::recursive_directory_iterator it(targets_, error);
  for (const fs::recursive_directory_iterator end; !error && it != end; it.increment(error)) {
    if (it.depth() >= kMaxDepth) it.disable_recursion_pending();
    if (!EqualsIgnoreCase(it->path().extension().string(), kExtension)) continue;
    if (files_.size() >= kMaxTargets)
      return {StatusCode::kLimit, "the folder has more than 50000 targets", targets_.string()};
    files_.insert(it->path().lexically_relative(targets_));
  }
  if (error) return {StatusCode::kIo, "cannot be listed: " + error.message(), targets_.string()};
  return {};
}

Status TargetStore::OpenArchive(const fs::path& file) {
  Result<std::string> bytes = ReadFile(file, NpzArchive::kMaxBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  Result<NpzArchive> archive = NpzArchive::Open(std::move(*bytes), file.string());
  FURROW_RETURN_IF_ERROR(archive);
  archive_ = std::move(*archive);
  archive_->ForEachName([&](const std::string& name) {
    if (!name.starts_with(kFolder) || !name.ends_with(kIndex)) return;
    const std::size_t end = name.size() - kIndex.size();
    if (end <= kFolder.size() || !archive_->Has(name.substr(0, end) + std::string(kVector))) return;
    fs::path target = name.substr(kFolder.size(), end - kFolder.size()) + std::string(kExtension);
    if (!files_.contains(target)) packed_.insert(std::move(target));
  });
  return {};
}

Result<MhTarget> TargetStore::Read(const fs::path& target, std::size_t num_base_vertices) const {
  if (!packed_.contains(target)) {
    const fs::path file = targets_ / target;
    const Result<std::string> text = ReadFile(file, kMaxTextFileBytes);
    FURROW_RETURN_IF_ERROR(text);
    return ParseMhTarget(*text, file.string(), num_base_vertices);
  }
  const std::string name = PackedName(target);
  const Result<std::string> index = archive_->Read(name + std::string(kIndex));
  FURROW_RETURN_IF_ERROR(index);
  const Result<std::string> vector = archive_->Read(name + std::string(kVector));
  FURROW_RETURN_IF_ERROR(vector);
  return ParseMhTargetArrays(*index, *vector,
                             (targets_.parent_path() / kArchive).string() + ": " + name,
                             num_base_vertices);
}

}  // namespace furrow::authoring
