// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhmat.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/ascii.h"
#include "base/files.h"
#include "base/numbers.h"
#include "base/text.h"
#include "base/text_cursor.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxPathBytes = 1024;

bool IsYes(std::string_view word) {
  return EqualsIgnoreCase(word, "true") || EqualsIgnoreCase(word, "yes") || word == "1";
}

class MhmatParser {
 public:
  MhmatParser(std::string_view text, std::string_view source)
      : cursor_(text, source), source_(source) {}

  Result<MhMaterial> Run() {
    std::string_view line;
    while (cursor_.NextLine(&line)) {
      SplitWords(line, &words_);
      if (words_.empty() || words_[0].starts_with("//")) continue;
      FURROW_RETURN_IF_ERROR(Statement());
    }
    if (!known_)
      return Status(StatusCode::kSchema, "the file has no line of a MakeHuman material",
                    std::string(source_));
    return std::move(material_);
  }

 private:
  Status Statement() {
    const std::string_view key = words_[0];
    if (words_.size() < 2) return {};
    if (key == "diffuseColor") return Colour();
    if (key == "diffuseTexture") return Path(&material_.colour_picture);
    if (key == "normalmapTexture") return Path(&material_.normal_picture);
    bool is_known = true;
    if (key == "name")
      material_.name = CutText(std::string(words_[1]), 240);
    else if (key == "transparent")
      material_.transparent = IsYes(words_[1]);
    else if (key == "backfaceCull")
      material_.double_sided = !IsYes(words_[1]);
    else
      is_known =
          key == "shader" || key == "shininess" || key == "opacity" || key == "autoBlendSkin";
    known_ = known_ || is_known;
    return {};
  }

  Status Colour() {
    known_ = true;
    if (words_.size() < 4) return cursor_.Error(StatusCode::kParse, "a colour needs three numbers");
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_[static_cast<std::size_t>(i) + 1];
      const std::optional<float> value = ToFloat(word);
      if (!value) return cursor_.Error(StatusCode::kParse, Quoted(word) + " is not a number");
      if (!std::isfinite(*value))
        return cursor_.Error(StatusCode::kNonFinite, Quoted(word) + " is not finite");
      material_.colour[i] = std::clamp(*value, 0.0f, 1.0f);
    }
    return {};
  }

  // File names may contain blanks.
  Status Path(std::string* path) {
    known_ = true;
    path->assign(words_[1]);
    for (std::size_t i = 2; i < words_.size(); ++i) {
      *path += ' ';
      *path += words_[i];
    }
    std::replace(path->begin(), path->end(), '\\', '/');
    if (path->size() > kMaxPathBytes)
      return cursor_.Error(StatusCode::kLimit, "the path is longer than 1024 bytes");
    return {};
  }

  TextCursor cursor_;
  std::string_view source_;
  std::vector<std::string_view> words_;
  bool known_ = false;
  MhMaterial material_;
};

}  // namespace

Result<MhMaterial> ParseMhmat(std::string_view text, std::string_view source) {
  if (IsGitLfsPointer(text))
    return Status(StatusCode::kUnsupported, "the file is a Git LFS pointer, not a material",
                  std::string(source), "run 'git lfs pull' in the data folder");
  return MhmatParser(text, source).Run();
}

}  // namespace furrow::authoring
