// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/obj.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/numbers.h"
#include "base/status.h"
#include "base/text.h"
#include "base/text_cursor.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxElements = 4'000'000;
constexpr float kMaxCoordinate = 1e6f;
constexpr std::size_t kMaxCorners = 64;
constexpr std::size_t kMaxGroups = 65'535;

// Reads positions, UVs, faces and groups, and skips all other statements. Faces keep their corners;
// triangulation comes later.
class ObjParser {
 public:
  ObjParser(std::string_view text, std::string_view source)
      : cursor_(text, source), source_(source) {
    // Faces before the first group belong to the unnamed one.
    mesh_.groups.emplace_back();
    group_index_.emplace("", 0);
  }

  Result<ObjMesh> Run() {
    std::string_view line;
    while (cursor_.NextLine(&line)) {
      SplitWords(line, &words_);
      if (words_.empty()) continue;
      FURROW_RETURN_IF_ERROR(Statement());
    }
    if (mesh_.faces.empty())
      return Status(StatusCode::kParse, "the file has no faces", std::string(source_),
                    "check that the file is an .obj");
    return std::move(mesh_);
  }

 private:
  Status Statement() {
    const std::string_view keyword = words_.front();
    if (keyword == "v") return Position();
    if (keyword == "vt") return Uv();
    if (keyword == "f") return AddFace();
    if (keyword == "g" || keyword == "o") return Group();
    return {};
  }

  Status Error(StatusCode code, std::string what) const {
    return cursor_.Error(code, std::move(what));
  }

  Status Numbers(std::size_t count, float* out) const {
    if (words_.size() < count + 1)
      return Error(StatusCode::kParse, "'" + std::string(words_[0]) + "' needs " +
                                           std::to_string(count) + " numbers; the line has " +
                                           std::to_string(words_.size() - 1));
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<float> value = ToFloat(words_[i + 1]);
      if (!value) return Error(StatusCode::kParse, Quoted(words_[i + 1]) + " is not a number");
      if (!std::isfinite(*value))
        return Error(StatusCode::kNonFinite, Quoted(words_[i + 1]) + " is not finite");
      if (std::abs(*value) > kMaxCoordinate)
        return Error(StatusCode::kLimit, Quoted(words_[i + 1]) + " is not in [-1000000, 1000000]");
      out[i] = *value;
    }
    return {};
  }

  Status Position() {
    if (mesh_.positions.size() >= kMaxElements)
      return Error(StatusCode::kLimit, "the file has more than 4000000 vertices");
    float xyz[3];
    FURROW_RETURN_IF_ERROR(Numbers(3, xyz));
    mesh_.positions.emplace_back(xyz[0], xyz[1], xyz[2]);
    return {};
  }

  Status Uv() {
    if (mesh_.uvs.size() >= kMaxElements)
      return Error(StatusCode::kLimit, "the file has more than 4000000 UVs");
    float uv[2];
    FURROW_RETURN_IF_ERROR(Numbers(2, uv));
    mesh_.uvs.emplace_back(uv[0], uv[1]);
    return {};
  }

  Status Group() {
    const std::string name(words_.size() > 1 ? words_[1] : std::string_view());
    const auto [it, added] = group_index_.emplace(name, mesh_.groups.size());
    if (added) {
      if (mesh_.groups.size() >= kMaxGroups)
        return Error(StatusCode::kLimit, "the file has more than 65535 groups");
      mesh_.groups.push_back(name);
    }
    group_ = static_cast<std::uint16_t>(it->second);
    return {};
  }

  // One index of a corner: 1 or more, or negative to count back from the latest.
  Status Index(std::string_view word, std::size_t count, const std::string& kind,
               const std::string& plural, std::int64_t* index) const {
    const std::optional<long> value = ToInteger(word);
    if (!value) return Error(StatusCode::kParse, Quoted(word) + " is not the index of a " + kind);
    *index = *value < 0 ? static_cast<std::int64_t>(count) + *value : *value - 1;
    if (*index < 0 || *index >= static_cast<std::int64_t>(count))
      return Error(StatusCode::kInvalidArgument,
                   kind + " index " + std::string(word) + " is out of range; the file has " +
                       Counted(count, kind, plural) + " up to this line");
    return {};
  }

  Status AddCorner(std::string_view word) {
    const std::size_t slash = word.find('/');
    std::int64_t position = 0;
    std::int64_t uv = -1;
    if (const Status status =
            Index(word.substr(0, slash), mesh_.positions.size(), "vertex", "vertices", &position);
        !status.ok())
      return status;
    if (slash != std::string_view::npos) {
      const std::string_view rest = word.substr(slash + 1);
      const std::string_view uv_word = rest.substr(0, rest.find('/'));
      if (!uv_word.empty()) {
        FURROW_RETURN_IF_ERROR(Index(uv_word, mesh_.uvs.size(), "UV", "UVs", &uv));
      }
    }
    mesh_.corners.push_back({static_cast<std::uint32_t>(position), static_cast<std::int32_t>(uv)});
    return {};
  }

  Status AddFace() {
    const std::size_t corners = words_.size() - 1;
    if (corners < 3 || corners > kMaxCorners)
      return Error(StatusCode::kParse,
                   "the face has " + Counted(corners, "corner") + "; a face needs 3 to 64");
    if (mesh_.corners.size() + corners > kMaxElements)
      return Error(StatusCode::kLimit, "the faces have more than 4000000 corners");
    const auto first = static_cast<std::uint32_t>(mesh_.corners.size());
    for (std::size_t i = 1; i < words_.size(); ++i) {
      FURROW_RETURN_IF_ERROR(AddCorner(words_[i]));
    }
    mesh_.faces.push_back({first, static_cast<std::uint16_t>(corners), group_});
    return {};
  }

  TextCursor cursor_;
  std::string_view source_;
  std::vector<std::string_view> words_;
  std::unordered_map<std::string, std::size_t> group_index_;
  std::uint16_t group_ = 0;
  ObjMesh mesh_;
};

}  // namespace

int ObjMesh::FindGroup(std::string_view name) const {
  const auto it = std::find(groups.begin(), groups.end(), name);
  return it == groups.end() ? -1 : static_cast<int>(it - groups.begin());
}

Result<ObjMesh> ParseObj(std::string_view text, std::string_view source) {
  return ObjParser(text, source).Run();
}

}  // namespace furrow::authoring
