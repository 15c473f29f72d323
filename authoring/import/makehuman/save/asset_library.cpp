// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/asset_library.h"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/ascii.h"
#include "base/files.h"
#include "base/text.h"
#include "base/text_cursor.h"
#include "character/pictures/picture_file.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxEntries = 20'000;
constexpr std::uint64_t kMaxMaterialBytes = 1 << 20;

// The first bytes of a file; empty if it cannot be read.
std::string StartOf(const fs::path& file, std::size_t bytes) {
  std::ifstream in(file, std::ios::binary);
  std::string text(bytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

// Every .mhclo file below `folder`, sorted. Symbolic links to folders are not followed.
std::vector<fs::path> ListParts(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator it(folder, error);
  for (const fs::recursive_directory_iterator end; !error && it != end; it.increment(error)) {
    if (it.depth() >= 6) it.disable_recursion_pending();
    std::error_code ignored;
    if (EqualsIgnoreCase(it->path().extension().string(), ".mhclo") &&
        it->is_regular_file(ignored) && files.size() < kMaxEntries)
      files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool IsInside(const fs::path& file, const fs::path& folder) {
  const fs::path relative = file.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

const std::vector<AssetLibrary::Entry>& AssetLibrary::EntriesOf(const std::string& kind) {
  const auto [found, added] = entries_.try_emplace(kind);
  if (!added) return found->second;
  constexpr std::size_t kHeaderBytes = 16 << 10;
  for (const fs::path& folder : folders_) {
    for (const fs::path& file : ListParts(folder / kind)) {
      Entry entry{file, {}, {}};
      const std::string header = StartOf(file, kHeaderBytes);
      TextCursor cursor(header, {});
      std::string_view line;
      std::vector<std::string_view> words;
      while (cursor.NextLine(&line)) {
        SplitWords(line, &words);
        if (words.empty()) continue;
        if (words[0] == "verts") break;
        if (words.size() < 2) continue;
        if (words[0] == "uuid") entry.uuid = AsciiLower(std::string(words[1]));
        if (words[0] != "name") continue;
        entry.name.assign(words[1].begin(), line.end());
        entry.name = AsciiLower(entry.name.substr(0, entry.name.find_last_not_of(" \t\r") + 1));
      }
      found->second.push_back(std::move(entry));
    }
  }
  return found->second;
}

std::optional<fs::path> AssetLibrary::FindPart(const MhmSave::Part& part) {
  const std::vector<Entry>& entries = EntriesOf(part.kind);
  const auto first = [&](const auto& matches) -> std::optional<fs::path> {
    const auto found = std::find_if(entries.begin(), entries.end(), matches);
    return found == entries.end() ? std::nullopt : std::optional(found->file);
  };
  const std::string uuid = AsciiLower(part.uuid);
  const std::string name = AsciiLower(part.name);
  if (!uuid.empty()) {
    if (auto file = first([&](const Entry& e) { return e.uuid == uuid; })) return file;
  }
  if (auto file = first([&](const Entry& e) { return e.name == name; })) return file;
  return first([&](const Entry& e) { return AsciiLower(e.file.stem().string()) == name; });
}

Result<fs::path> AssetLibrary::Locate(const std::string& path, const fs::path& beside) const {
  const fs::path relative(path);
  if (path.empty() || relative.is_absolute() || path.find('\0') != std::string::npos)
    return Status(StatusCode::kInvalidArgument, Quoted(path) + " is not a relative path");
  std::vector<fs::path> candidates;
  if (!beside.empty()) candidates.push_back(beside / relative);
  for (const fs::path& folder : folders_) {
    candidates.push_back(folder / relative);
    // MakeHuman also writes paths from above its data folder.
    if (*relative.begin() == "data") candidates.push_back(folder / path.substr(5));
  }
  bool may_exist = false;
  for (const fs::path& candidate : candidates) {
    const fs::path file = candidate.lexically_normal();
    const bool inside = std::any_of(folders_.begin(), folders_.end(), [&](const fs::path& folder) {
      return IsInside(file, folder.lexically_normal());
    });
    may_exist = may_exist || inside;
    std::error_code error;
    if (inside && fs::is_regular_file(file, error)) return file;
  }
  if (!may_exist)
    return Status(StatusCode::kInvalidArgument, Quoted(path) + " leaves the data folder");
  return Status(StatusCode::kNotFound, Quoted(path) + " does not exist in the data folder");
}

Result<FoundMaterial> AssetLibrary::LoadMaterial(const std::string& path,
                                                 const fs::path& beside) const {
  const Result<fs::path> file = Locate(path, beside);
  FURROW_RETURN_IF_ERROR(file);
  const Result<std::string> text = ReadFile(*file, kMaxMaterialBytes);
  FURROW_RETURN_IF_ERROR(text);
  Result<MhMaterial> material = ParseMhmat(*text, file->string());
  FURROW_RETURN_IF_ERROR(material);
  return FoundMaterial{std::move(*material), *file};
}

Result<character::Picture> AssetLibrary::LoadMaterialPicture(const FoundMaterial& material,
                                                             const std::string& picture,
                                                             const std::string& name) const {
  const Result<fs::path> file = Locate(picture, material.file.parent_path());
  if (!file.ok()) return file.status().At(material.file.string());
  return character::LoadPicture(name, *file);
}

}  // namespace furrow::authoring
