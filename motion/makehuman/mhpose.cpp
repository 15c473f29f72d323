// SPDX-License-Identifier: Apache-2.0
#include "motion/makehuman/mhpose.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "base/json_index.h"
#include "base/status.h"
#include "base/text.h"

namespace furrow::motion {
namespace {

// Keeps the order of the fields, because rotations do not commute.
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxNameBytes = 240;

Status SchemaError(std::string_view source, const std::string& field, std::string what) {
  return {StatusCode::kSchema, std::move(what), std::string(source) + ": " + field};
}

// JsonIndex goes first: it limits depth and size, and its errors state the line.
Result<Json> ParseObject(std::string_view text, std::string_view source) {
  if (text.size() > kMaxMhposeBytes)
    return Status(StatusCode::kLimit, "the file is larger than 1 MiB", std::string(source));
  const Result<JsonIndex> index = JsonIndex::Create(text);
  if (!index.ok()) {
    return Status(index.status().code(), index.status().what(),
                  std::string(source) + ":" + index.status().where());
  }
  Json json = Json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false,
                          /*ignore_comments=*/true);
  if (json.is_discarded())
    return Status(StatusCode::kParse, "invalid JSON or UTF-8", std::string(source));
  if (!json.is_object()) return SchemaError(source, "(whole file)", "must be a JSON object");
  return json;
}

bool IsPrintable(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
  });
}

std::string NameOf(const Json& json) {
  const auto name = json.find("name");
  if (name == json.end() || !name->is_string()) return {};
  const auto& text = name->get_ref<const std::string&>();
  return text.size() <= kMaxNameBytes && IsPrintable(text) ? text : std::string();
}

Result<float> WeightOf(const std::string& unit, const Json& value, std::string_view source,
                       ClipReport* report) {
  const std::string field = "unit_poses." + unit;
  if (!value.is_number()) return SchemaError(source, field, "must be a number");
  const double weight = value.get<double>();
  if (!std::isfinite(weight))
    return Status(StatusCode::kNonFinite, "is not finite", std::string(source) + ": " + field);
  const double clamped = std::clamp(weight, 0.0, 1.0);
  if (clamped != weight && report != nullptr) {
    report->warnings.push_back(std::string(source) + ": " + field + " is " + value.dump() +
                               ", outside [0, 1]; " + (weight > 1.0 ? "1" : "0") + " is used");
  }
  return static_cast<float>(clamped);
}

}  // namespace

Result<MhPose> ParseMhpose(std::string_view text, std::string_view source, ClipReport* report) {
  const Result<Json> json = ParseObject(text, source);
  FURROW_RETURN_IF_ERROR(json);
  const auto units = json->find("unit_poses");
  if (units == json->end())
    return Status(StatusCode::kSchema, "the file has no field \"unit_poses\"", std::string(source),
                  "use an expression of MakeHuman's folder expressions");
  if (!units->is_object()) return SchemaError(source, "unit_poses", "must be an object of weights");
  if (units->size() > kMaxPoseUnits)
    return Status(StatusCode::kLimit, "more than 4096 pose units",
                  std::string(source) + ": unit_poses");
  MhPose pose;
  pose.name = NameOf(*json);
  for (const auto& [unit, value] : units->items()) {
    const Result<float> weight = WeightOf(unit, value, source, report);
    FURROW_RETURN_IF_ERROR(weight);
    pose.units.emplace_back(unit, *weight);
  }
  return pose;
}

Result<std::vector<std::string>> ParsePoseUnitNames(std::string_view text,
                                                    std::string_view source) {
  const Result<Json> json = ParseObject(text, source);
  FURROW_RETURN_IF_ERROR(json);
  const auto list = json->find("framemapping");
  if (list == json->end() || !list->is_array() || list->empty())
    return SchemaError(source, "framemapping", "must be a list of at least one frame name");
  if (list->size() > kMaxPoseUnits)
    return Status(StatusCode::kLimit, "more than 4096 frame names",
                  std::string(source) + ": framemapping");
  std::vector<std::string> names;
  for (const Json& name : *list) {
    if (!name.is_string())
      return SchemaError(source, "framemapping", "must contain nothing but frame names");
    names.push_back(name.get<std::string>());
  }
  return names;
}

Result<Clip> BlendPoseUnits(const MhPose& pose, const std::vector<std::string>& names,
                            const Clip& units, std::string_view source) {
  const auto num_joints = static_cast<std::size_t>(units.skeleton.num_joints());
  if (num_joints == 0)
    return Status(StatusCode::kSchema, "the pose units have no joints", std::string(source));
  if (names.size() > static_cast<std::size_t>(units.num_frames()))
    return Status(StatusCode::kSchema,
                  "face-poseunits.json names " + Counted(names.size(), "frame") +
                      ", but face-poseunits.bvh has " + std::to_string(units.num_frames()),
                  std::string(source), "use both files of the same MakeHuman version");
  Clip clip;
  clip.name = pose.name;
  clip.skeleton = units.skeleton;
  clip.times = {0.0};
  clip.locals.assign(units.skeleton.rest_pose().begin(), units.skeleton.rest_pose().end());
  std::vector<glm::quat> turns(num_joints, glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
  for (const auto& [unit, weight] : pose.units) {
    const auto found = std::find(names.begin(), names.end(), unit);
    if (found == names.end())
      return Status(StatusCode::kNotFound, "face-poseunits.json has no pose unit " + Quoted(unit),
                    std::string(source) + ": unit_poses." + unit);
    const std::size_t first = static_cast<std::size_t>(found - names.begin()) * num_joints;
    for (std::size_t j = 0; j < num_joints; ++j) {
      const glm::quat departure =
          glm::inverse(clip.locals[j].rotation) * units.locals[first + j].rotation;
      turns[j] = glm::slerp(glm::quat(1.0f, 0.0f, 0.0f, 0.0f), departure, weight) * turns[j];
    }
  }
  for (std::size_t j = 0; j < num_joints; ++j)
    clip.locals[j].rotation = glm::normalize(clip.locals[j].rotation * turns[j]);
  return clip;
}

}  // namespace furrow::motion
