// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/strokes_file.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>

#include <flatbuffers/flatbuffers.h>

#include "authoring/bake/request/request_check.h"
#include "authoring/bake/strokes_generated.h"
#include "authoring/bake/strokes_schema_text.h"
#include "base/checked_json.h"
#include "base/files.h"
#include "base/status.h"
#include "wrinkle/fields/rig_field.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::authoring {
namespace {

using wrinkle::FieldAt;
using wrinkle::InvalidField;

constexpr std::size_t kMaxStrokes = 4096;
constexpr std::size_t kMaxPoints = 1024;  // per stroke
constexpr float kFarthest =
    100.0f;  // from the origin, metres; a larger value is a mistake of units

template <class Item>
bool IsNameOf(const std::vector<Item>& items, std::string_view name) {
  return std::any_of(items.begin(), items.end(),
                     [&](const Item& item) { return item.name == name; });
}

// Names must exist in the rig: a misspelt map would silently get no fold.
Status CheckNames(const BakeStroke& stroke, const wrinkle::Rig& rig, const std::string& at) {
  FURROW_RETURN_IF_ERROR(wrinkle::CheckLabel(stroke.name, at + ".name"));
  if (stroke.maps.empty()) return InvalidField("a stroke needs at least one map", at + ".maps");
  for (std::size_t i = 0; i < stroke.maps.size(); ++i) {
    if (IsNameOf(rig.wrinkle_maps, stroke.maps[i])) continue;
    return InvalidField("the rig has no wrinkle map '" + stroke.maps[i] + "'",
                        FieldAt(at + ".maps", i));
  }
  if (stroke.region.empty() || IsNameOf(rig.regions, stroke.region)) return {};
  return InvalidField("the rig has no region '" + stroke.region + "'", at + ".region");
}

// The schema cannot bound numbers. The far limit catches centimetres and millimetres given as
// metres.
Status ReadPoints(const flatbuffers::Vector<const schema::Vec3*>& from, const std::string& at,
                  std::vector<glm::vec3>* points) {
  if (from.size() < 2) return InvalidField("a stroke needs at least 2 points", at);
  if (from.size() > kMaxPoints) {
    return {StatusCode::kLimit,
            "has " + std::to_string(from.size()) + " points; the limit is " +
                std::to_string(kMaxPoints),
            at};
  }
  for (flatbuffers::uoffset_t i = 0; i < from.size(); ++i) {
    const schema::Vec3& point = *from.Get(i);
    points->push_back({point.x(), point.y(), point.z()});
    for (int axis = 0; axis < 3; ++axis) {
      const float value = points->back()[axis];
      if (!std::isfinite(value)) {
        return {StatusCode::kNonFinite, "the number is not finite", FieldAt(at, i)};
      }
      if (std::abs(value) <= kFarthest) continue;
      return InvalidField("the number is not in [-100, 100]; points are in metres", FieldAt(at, i));
    }
  }
  return {};
}

// The schema check has verified that required fields exist, so only optional ones may be null.
Status ReadStroke(const schema::Stroke& from, const wrinkle::Rig& rig, const std::string& at,
                  BakeStroke* to) {
  // JSON may give an enumerator as any number.
  if (from.kind() < schema::Kind::MIN || from.kind() > schema::Kind::MAX) {
    return InvalidField("invalid value", at + ".kind");
  }
  to->name = from.name()->str();
  to->kind = static_cast<BakeStroke::Kind>(from.kind());
  if (from.muscle() != nullptr) to->muscle = from.muscle()->str();
  for (const flatbuffers::String* map : *from.maps()) to->maps.push_back(map->str());
  if (from.region() != nullptr) to->region = from.region()->str();
  to->smooth = from.smooth();
  to->width_mm = from.width_mm();
  to->depth_mm = from.depth_mm();
  to->ridge = from.ridge();
  to->taper = from.taper();
  to->personal = from.personal();
  to->wavelength_mm = from.wavelength_mm();
  FURROW_RETURN_IF_ERROR(CheckNames(*to, rig, at));
  FURROW_RETURN_IF_ERROR(CheckStrokeNumbers(*to, at));
  return ReadPoints(*from.points(), at + ".points", &to->points);
}

// Exchanges "_l" and "_r" at the end of a name. Other names stay unchanged.
std::string OtherSide(std::string name) {
  if (name.ends_with("_l")) {
    name.back() = 'r';
  } else if (name.ends_with("_r")) {
    name.back() = 'l';
  }
  return name;
}

// The character faces +Z, so x = 0 is its plane of symmetry.
BakeStroke Mirrored(BakeStroke stroke) {
  const std::string other = OtherSide(stroke.name);
  stroke.name = other == stroke.name ? other + "_mirrored" : other;
  stroke.region = OtherSide(stroke.region);
  for (glm::vec3& point : stroke.points) point.x = -point.x;
  return stroke;
}

Result<std::vector<BakeStroke>> ReadStrokes(const schema::Strokes& tables,
                                            const wrinkle::Rig& rig) {
  if (tables.version() != 1) {
    return Status(
        StatusCode::kUnsupported,
        "unsupported version " + std::to_string(tables.version()) + "; the supported version is 1",
        "version");
  }
  std::vector<BakeStroke> strokes;
  std::unordered_set<std::string> names;
  for (flatbuffers::uoffset_t i = 0; i < tables.strokes()->size(); ++i) {
    const schema::Stroke& from = *tables.strokes()->Get(i);
    const std::string at = FieldAt("strokes", i);
    BakeStroke stroke;
    FURROW_RETURN_IF_ERROR(ReadStroke(from, rig, at, &stroke));
    strokes.push_back(stroke);
    if (from.mirror()) {
      strokes.push_back(Mirrored(stroke));
      FURROW_RETURN_IF_ERROR(CheckNames(strokes.back(), rig, at));
    }
    for (std::size_t k = strokes.size() - (from.mirror() ? 2 : 1); k < strokes.size(); ++k) {
      if (names.insert(strokes[k].name).second) continue;
      return InvalidField("the name '" + strokes[k].name + "' is used twice", at + ".name");
    }
    if (strokes.size() > kMaxStrokes) {
      return Status(StatusCode::kLimit, "more than " + std::to_string(kMaxStrokes) + " strokes",
                    "strokes");
    }
  }
  return strokes;
}

}  // namespace

Result<std::vector<BakeStroke>> ParseStrokes(std::string_view json, std::string_view source_name,
                                             const wrinkle::Rig& rig) {
  const Result<CheckedJson> checked = CheckedJson::Parse(
      json, source_name, {kStrokesSchemaText, "Strokes", "authoring/bake/strokes.fbs"});
  FURROW_RETURN_IF_ERROR(checked);
  auto strokes = ReadStrokes(*flatbuffers::GetRoot<schema::Strokes>(checked->buffer()), rig);
  if (!strokes.ok()) return checked->Located(strokes.status());
  return strokes;
}

Result<std::vector<BakeStroke>> LoadStrokes(const std::filesystem::path& path,
                                            const wrinkle::Rig& rig) {
  const Result<std::string> text = ReadFile(path, JsonIndex::kMaxBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseStrokes(*text, path.string(), rig);
}

}  // namespace furrow::authoring
