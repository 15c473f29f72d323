// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "base/text.h"
#include "rig/json/map_file.h"
#include "rig/skeleton_map.h"

namespace furrow::rig {
namespace {

using Json = nlohmann::json;
using wrinkle::JointRole;

// Limits on hostile files. The largest map that ships is far below all of them.
constexpr std::size_t kMaxPrefixes = 64;
constexpr std::size_t kMaxChain = 16;
constexpr std::size_t kMaxName = 255;

// Reads one file. Every error names the file and the field.
class MapReader : private MapErrors {
 public:
  using MapErrors::MapErrors;

  Status Read(const Json& root, SkeletonMap* map);

 private:
  Status ReadText(const Json& value, const std::string& field, std::string* text) const;
  Status ReadPrefixes(const Json& root, SkeletonMap* map) const;
  Status ReadSides(const Json& root);
  Status ReadJoints(const Json& root, SkeletonMap* map);
  Status ReadRole(const std::string& key, const Json& value, SkeletonMap* map);
  Status AddEntry(const std::string& role, const Json& value, const std::string& side,
                  const std::string& field, SkeletonMap* map);
  // One place of a chain: a name, or alternatives separated by '|'.
  Status AddPlace(const Json& value, const std::string& side, const std::string& field,
                  SkeletonMap::Entry* entry) const;

  std::string left_;
  std::string right_;
  std::set<JointRole> seen_;
};

std::vector<std::string> Alternatives(const std::string& text) {
  std::vector<std::string> names;
  std::size_t start = 0;
  for (std::size_t end = 0; end != std::string::npos; start = end + 1) {
    end = text.find('|', start);
    names.push_back(text.substr(start, end == std::string::npos ? end : end - start));
  }
  return names;
}

Status MapReader::ReadText(const Json& value, const std::string& field, std::string* text) const {
  if (!value.is_string()) return Error(field, "expected a string");
  *text = value.get<std::string>();
  if (text->size() > kMaxName) return Error(field, "is longer than 255 bytes", StatusCode::kLimit);
  return {};
}

Status MapReader::ReadPrefixes(const Json& root, SkeletonMap* map) const {
  if (!root.contains("prefixes")) return {};
  const Json& list = root["prefixes"];
  if (!list.is_array()) return Error("prefixes", "expected a list");
  if (list.size() > kMaxPrefixes)
    return Error("prefixes", "has more than 64 entries", StatusCode::kLimit);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string field = "prefixes[" + std::to_string(i) + "]";
    std::string prefix;
    FURROW_RETURN_IF_ERROR(ReadText(list[i], field, &prefix));
    if (prefix.empty() || prefix == "*") return Error(field, "is empty");
    map->prefixes.push_back(std::move(prefix));
  }
  return {};
}

Status MapReader::ReadSides(const Json& root) {
  if (!root.contains("sides")) return {};
  const Json& sides = root["sides"];
  if (!sides.is_object() || sides.size() != 2 || !sides.contains("left") ||
      !sides.contains("right")) {
    return Error("sides", "expected {\"left\": ..., \"right\": ...}");
  }
  FURROW_RETURN_IF_ERROR(ReadText(sides["left"], "sides.left", &left_));
  FURROW_RETURN_IF_ERROR(ReadText(sides["right"], "sides.right", &right_));
  if (left_ == right_ || left_.empty() || right_.empty()) {
    return Error("sides", "left and right must differ and must not be empty");
  }
  return {};
}

Status MapReader::AddPlace(const Json& value, const std::string& side, const std::string& field,
                           SkeletonMap::Entry* entry) const {
  std::string text;
  FURROW_RETURN_IF_ERROR(ReadText(value, field, &text));
  // A '*' in a name stands for the side, and only entries with a '*' in the role have one.
  if (text.find('*') != std::string::npos && side.empty()) {
    return Error(field, "a '*' in a name requires a '*' in its role, and \"sides\"");
  }
  std::vector<std::string> names = Alternatives(WithSide(text, side));
  // An empty name could match a joint that consists of a prefix alone.
  if (std::ranges::any_of(names, &std::string::empty))
    return Error(field, "contains an empty name");
  entry->chain.push_back(std::move(names));
  return {};
}

// Reads `value` in place, because copying deeply nested JSON would overflow the stack.
Status MapReader::AddEntry(const std::string& role, const Json& value, const std::string& side,
                           const std::string& field, SkeletonMap* map) {
  SkeletonMap::Entry entry;
  const auto parsed = wrinkle::ParseJointRole(role);
  if (!parsed)
    return Error(field, Quoted(role) + " is not a role; docs/SKELETONS.md lists the roles");
  entry.role = *parsed;
  if (!seen_.insert(entry.role).second) return Error(field, "duplicate role");
  if (!value.is_array()) {
    FURROW_RETURN_IF_ERROR(AddPlace(value, side, field, &entry));
  } else if (value.empty()) {
    return Error(field, "expected at least one joint");
  } else if (value.size() > kMaxChain) {
    return Error(field, "has more than 16 joints", StatusCode::kLimit);
  } else {
    for (const Json& item : value) {
      FURROW_RETURN_IF_ERROR(AddPlace(item, side, field, &entry));
    }
  }
  map->entries.push_back(std::move(entry));
  return {};
}

// "*UpperArm" stands for the role on both sides.
Status MapReader::ReadRole(const std::string& key, const Json& value, SkeletonMap* map) {
  const std::string field = "joints." + std::string(Quoted(key));
  if (!key.starts_with('*')) return AddEntry(key, value, "", field, map);
  if (left_.empty()) return Error(field, "a '*' in a role requires \"sides\"");
  const std::string rest = key.substr(1);
  FURROW_RETURN_IF_ERROR(AddEntry("left" + rest, value, left_, field, map));
  return AddEntry("right" + rest, value, right_, field, map);
}

Status MapReader::ReadJoints(const Json& root, SkeletonMap* map) {
  const Json& joints = root["joints"];
  if (!joints.is_object() || joints.empty())
    return Error("joints", "expected an object with one field per role");
  for (const auto& [key, value] : joints.items()) {
    FURROW_RETURN_IF_ERROR(ReadRole(key, value, map));
  }
  // Sorts the entries by role, so that their order in the file does not matter.
  std::ranges::sort(map->entries, {}, &SkeletonMap::Entry::role);
  return {};
}

Status MapReader::Read(const Json& root, SkeletonMap* map) {
  FURROW_RETURN_IF_ERROR(
      CheckRoot(root, "joints", {"title", "prefixes", "ignore_case", "sides", "toes_height"}));
  FURROW_RETURN_IF_ERROR(ReadText(root["name"], "name", &map->name));
  if (map->name.empty()) return Error("name", "is empty");
  if (root.contains("title")) {
    FURROW_RETURN_IF_ERROR(ReadText(root["title"], "title", &map->title));
  }
  if (root.contains("ignore_case")) {
    if (!root["ignore_case"].is_boolean()) return Error("ignore_case", "expected true or false");
    map->ignore_case = root["ignore_case"].get<bool>();
  }
  if (root.contains("toes_height")) {
    const Json& height = root["toes_height"];
    if (!height.is_number()) return Error("toes_height", "expected a number");
    map->toes_height = height.get<float>();
    // Leg lengths. The negation also rejects NaN.
    if (!(*map->toes_height >= 0.0f && *map->toes_height <= 0.5f)) {
      return Error("toes_height", "must be between 0 and 0.5 leg lengths",
                   StatusCode::kInvalidArgument);
    }
  }
  FURROW_RETURN_IF_ERROR(ReadPrefixes(root, map));
  // Before the joints, whose names refer to the sides.
  FURROW_RETURN_IF_ERROR(ReadSides(root));
  return ReadJoints(root, map);
}

}  // namespace

Result<SkeletonMap> ParseSkeletonMap(std::string_view json, std::string_view source_name) {
  Json root;
  FURROW_RETURN_IF_ERROR(ParseMapText(json, source_name, &root));
  SkeletonMap map;
  FURROW_RETURN_IF_ERROR(MapReader(source_name).Read(root, &map));
  return map;
}

}  // namespace furrow::rig
