// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/ascii.h"
#include "base/numbers.h"
#include "base/text.h"
#include "base/text_cursor.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxTextBytes = 240;  // of a name or path
constexpr std::size_t kMaxWarnings = 16;

constexpr std::array<std::string_view, 7> kPartKinds{"eyes",  "hair",   "eyebrows", "eyelashes",
                                                     "teeth", "tongue", "clothes"};
// Settings of MakeHuman's window, and names that change nothing.
constexpr std::array<std::string_view, 5> kIdleKinds{"camera", "tags", "uuid", "subdivide",
                                                     "background"};

bool Contains(std::span<const std::string_view> list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// 8-4-4-4-12 hexadecimal digits.
bool IsUuid(std::string_view word) {
  if (word.size() != 36) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = AsciiLower(word[i]);
    const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
    if (dash ? c != '-' : !((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'))) return false;
  }
  return true;
}

// Messages and file names show these texts.
std::string Clean(std::string_view text) {
  std::string clean(text);
  std::replace_if(
      clean.begin(), clean.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return clean;
}

bool IsTrue(std::string_view word) {
  return EqualsIgnoreCase(word, "true") || EqualsIgnoreCase(word, "yes");
}

class MhmParser {
 public:
  MhmParser(std::string_view text, std::string_view source)
      : cursor_(text, source), source_(source) {}

  Result<MhmSave> Run() {
    std::string_view line;
    bool known = false;
    while (cursor_.NextLine(&line)) {
      SplitWords(line, &words_);
      if (words_.empty()) continue;
      Result<bool> used = Statement();
      FURROW_RETURN_IF_ERROR(used);
      known = known || *used;
    }
    if (!known)
      return Status(StatusCode::kSchema, "the file has no line of a MakeHuman save",
                    std::string(source_), "use a .mhm file that MakeHuman wrote");
    CheckAge();
    if (unwarned_ > 0)
      save_.warnings.push_back(std::string(source_) + ": " + Counted(unwarned_, "more warning"));
    return std::move(save_);
  }

 private:
  void CheckAge() {
    const std::string where(source_);
    if (save_.modifiers.empty()) {
      save_.warnings.push_back(where +
                               ": the save has no modifiers, so the person is average; saves "
                               "older than version 1.0 must be saved again in a newer MakeHuman");
    } else if (save_.version.starts_with("v1.0") || save_.version.starts_with("1.0")) {
      save_.warnings.push_back(where + ": the save is of version " + Quoted(save_.version) +
                               "; modifiers that version 1.1 renamed are skipped");
    }
  }

  // True if the line is one of a save.
  Result<bool> Statement() {
    const std::string_view kind = words_.front();
    if (Contains(kIdleKinds, kind)) return true;
    if (words_.size() < 2) {
      Warn("the line " + Quoted(kind) + " has no value; skipped");
      return false;
    }
    for (const std::string_view word : words_) {
      if (word.size() > kMaxTextBytes)
        return cursor_.Error(StatusCode::kLimit, Quoted(word) + " is longer than 240 bytes");
    }
    if (kind == "modifier")
      FURROW_RETURN_IF_ERROR(Modifier());
    else if (Contains(kPartKinds, kind))
      FURROW_RETURN_IF_ERROR(Part());
    else if (kind == "material")
      FURROW_RETURN_IF_ERROR(Material());
    else
      return Setting(kind);
    return true;
  }

  bool Setting(std::string_view kind) {
    if (kind == "version")
      save_.version = Rest(1);
    else if (kind == "name")
      save_.name = Rest(1);
    else if (kind == "skinMaterial")
      save_.skin_material = Rest(1);
    else if (kind == "skeleton")
      save_.skeleton = Rest(1);
    else if (kind == "clothesHideFaces")
      save_.clothes_hide_faces = IsTrue(words_[1]);
    else if (kind == "pose" || kind == "expression")
      Warn("the " + std::string(kind) + " " + Quoted(Rest(1)) +
           " is not imported; play its file as a recording instead");
    else if (kind == "proxy")
      Warn("the topology " + Quoted(Rest(1)) + " is not imported; the base mesh is used instead (" +
           std::string(kToKeepIt) + ")");
    else {
      Warn("unknown line " + Quoted(kind) + "; skipped");
      return false;
    }
    return true;
  }

  Status Modifier() {
    if (words_.size() < 3)
      return cursor_.Error(StatusCode::kParse, "a modifier needs a name and a value");
    const std::optional<float> value = ToFloat(words_.back());
    if (!value)
      return cursor_.Error(StatusCode::kParse, Quoted(words_.back()) + " is not a number");
    if (!std::isfinite(*value))
      return cursor_.Error(StatusCode::kNonFinite, Quoted(words_.back()) + " is not finite");
    const float clamped = std::clamp(*value, -1.0f, 1.0f);
    if (clamped != *value)
      Warn("the value " + std::string(words_.back()) + " is outside [-1, 1]; " +
           (clamped > 0.0f ? "1" : "-1") + " is used");
    const std::string name = Rest(1, words_.size() - 1);  // may contain blanks
    const auto [it, added] = index_.emplace(name, save_.modifiers.size());
    if (!added) {
      save_.modifiers[it->second].value = clamped;
      return {};
    }
    if (save_.modifiers.size() >= kMaxMhmModifiers)
      return cursor_.Error(StatusCode::kLimit, "the file has more than 4096 modifiers");
    save_.modifiers.push_back({name, clamped});
    return {};
  }

  // "clothes My shirt 79ced554-...": names may contain blanks.
  Status Part() {
    if (save_.parts.size() >= kMaxMhmParts)
      return cursor_.Error(StatusCode::kLimit, "the file has more than 256 parts");
    const bool has_uuid = words_.size() > 2;
    MhmSave::Part part;
    part.kind = std::string(words_[0]);
    part.name = Rest(1, words_.size() - (has_uuid ? 1 : 0));
    if (has_uuid) part.uuid = Clean(words_.back());
    save_.parts.push_back(std::move(part));
    return {};
  }

  // "material NAME UUID PATH": names and paths may contain blanks.
  Status Material() {
    if (save_.materials.size() >= kMaxMhmParts)
      return cursor_.Error(StatusCode::kLimit, "the file has more than 256 materials");
    const auto found = std::find_if(words_.begin() + 1, words_.end(), IsUuid);
    std::size_t uuid = static_cast<std::size_t>(found - words_.begin());
    if (uuid == words_.size()) uuid = 2;
    if (uuid < 2 || uuid + 1 >= words_.size()) {
      Warn("a material needs a name, a UUID and a file; skipped");
      return {};
    }
    save_.materials.push_back({Rest(1, uuid), Clean(words_[uuid]), Rest(uuid + 1, words_.size())});
    return {};
  }

  // Words [begin, end), separated by one blank.
  std::string Rest(std::size_t begin, std::size_t end) const {
    std::string text;
    for (std::size_t i = begin; i < end; ++i) {
      if (!text.empty()) text += ' ';
      text += words_[i];
    }
    return Clean(text);
  }
  std::string Rest(std::size_t begin) const { return Rest(begin, words_.size()); }

  void Warn(const std::string& what) {
    if (save_.warnings.size() < kMaxWarnings) {
      save_.warnings.push_back(cursor_.Where() + ": " + what);
    } else {
      ++unwarned_;
    }
  }

  TextCursor cursor_;
  std::string_view source_;
  std::vector<std::string_view> words_;
  std::map<std::string, std::size_t> index_;  // of modifiers by name
  std::size_t unwarned_ = 0;
  MhmSave save_;
};

}  // namespace

Result<MhmSave> ParseMhm(std::string_view text, std::string_view source) {
  if (text.size() > kMaxMhmBytes)
    return Status(StatusCode::kLimit, "the file is larger than 1 MiB", std::string(source));
  return MhmParser(text, source).Run();
}

}  // namespace furrow::authoring
