// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/rig_api.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "rig/rig_file.h"
#include "server/http/request/json_reply.h"
#include "wrinkle/solver/explain.h"
#include "wrinkle/weights/modulation_curve.h"

namespace furrow::server {
namespace {

using wrinkle::Driver;

std::string_view CombineName(wrinkle::Combine combine) {
  switch (combine) {
    case wrinkle::Combine::kMax: return "max";
    case wrinkle::Combine::kSum: return "sum";
    case wrinkle::Combine::kMean: return "mean";
    case wrinkle::Combine::kSumModulated: return "sum_modulated";
  }
  return "";
}

// The points of a curve, [[x, y], ...]; null if a named modulation counts.
Json CurveJson(std::span<const wrinkle::CurvePoint> curve) {
  if (curve.empty()) return nullptr;
  Json points = Json::array();
  for (const wrinkle::CurvePoint& point : curve) points.push_back({point.x, point.y});
  return points;
}

// Where the wrinkles of a region show: a channel of a texture, the skin weights, or the side that a
// joint moves to.
Json MaskJson(const wrinkle::Mask& mask) {
  switch (mask.kind) {
    case wrinkle::Mask::Kind::kSkinning: return {{"kind", "skinning"}};
    case wrinkle::Mask::Kind::kSliding: return {{"kind", "sliding"}, {"driver", mask.driver}};
    case wrinkle::Mask::Kind::kTexture: break;
  }
  // A rig may be made by hand; the index below must stay inside "rgba".
  const auto channel = static_cast<std::size_t>(std::clamp(mask.channel, 0, 3));
  return {
      {"kind", "texture"}, {"texture", mask.texture}, {"channel", std::string(1, "rgba"[channel])}};
}

// A region with its weights and what feeds each of them.
Json RegionJson(const wrinkle::Rig& rig, const wrinkle::Region& region) {
  Json weights = Json::array();
  for (const wrinkle::Feed& feed : region.feeds) {
    Json sources = Json::array();
    for (const auto& source : feed.sources) {
      sources.push_back({{"value", source.driver + "." + source.value}, {"gain", source.gain}});
    }
    const wrinkle::FeedModulation modulation = ModulationOf(rig, region, feed);
    weights.push_back({{"name", region.name + "." + feed.map},
                       {"map", feed.map},
                       {"modulation", wrinkle::ModulationName(modulation)},
                       {"curve", CurveJson(modulation.curve)},
                       {"sources", std::move(sources)}});
  }
  return {{"name", region.name},
          {"mask", MaskJson(region.mask)},
          {"combine", CombineName(region.combine)},
          {"modulation",
           wrinkle::ModulationName({.modulation = region.modulation, .curve = region.curve})},
          {"neighbours", region.neighbours},
          {"weights", std::move(weights)}};
}

// A rig does not list the values of a driver in one place. They are the values that a pose driver
// defines and those that regions use.
Json DriverJson(const Driver& driver, const wrinkle::Rig& rig) {
  Json values = Json::array();
  const auto add = [&](const std::string& value, const Json& reference_pose) {
    const std::string name = driver.name + "." + value;
    const auto is_known = [&](const Json& known) { return known["name"] == name; };
    // Several regions may use one value. Pose values come first, so that their reference pose is
    // kept.
    if (std::ranges::none_of(values, is_known)) {
      values.push_back({{"name", name}, {"reference_pose", reference_pose}});
    }
  };
  if (driver.kind == Driver::Kind::kPose) {
    for (const auto& value : driver.pose.values) add(value.name, value.reference_pose);
  }
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      for (const auto& source : feed.sources) {
        if (source.driver == driver.name) add(source.value, nullptr);
      }
    }
  }
  return {
      {"name", driver.name}, {"kind", DriverKindName(driver.kind)}, {"values", std::move(values)}};
}

// The driver of "driver.value"; null if the rig has none of that name.
const Driver* FindDriver(const wrinkle::Rig& rig, std::string_view driver_value) {
  const std::string_view name = driver_value.substr(0, driver_value.rfind('.'));
  const auto found = std::ranges::find(rig.drivers, name, &Driver::name);
  return found == rig.drivers.end() ? nullptr : &*found;
}

// The reference pose behind "driver.value"; null for drivers that have none.
Json ReferencePoseOf(const Driver& driver, std::string_view driver_value) {
  const std::string_view value = driver_value.substr(driver_value.rfind('.') + 1);
  for (const auto& known : driver.pose.values) {
    if (driver.kind == Driver::Kind::kPose && known.name == value) return known.reference_pose;
  }
  return nullptr;
}

// These four give the details of one kind of driver, or null for a driver of another kind, so that
// all contributions have the same fields.
Json PoseJson(const wrinkle::Explanation& explanation, const std::string& driver_value) {
  for (const auto& pose : explanation.pose_values) {
    if (pose.driver_value != driver_value) continue;
    return {
        {"displacement", pose.displacement},   {"moved", pose.moved},     {"along", pose.along},
        {"perpendicular", pose.perpendicular}, {"falloff", pose.falloff}, {"result", pose.result}};
  }
  return nullptr;
}

Json AnglesJson(const wrinkle::Explanation& explanation, const std::string& driver) {
  Json angles = Json::array();
  for (const auto& angle : explanation.angles) {
    if (angle.driver != driver) continue;
    angles.push_back({{"what", angle.what}, {"degrees", angle.degrees}});
  }
  if (angles.empty()) return nullptr;
  return angles;
}

Json StrainJson(const wrinkle::Explanation& explanation, const std::string& driver) {
  for (const auto& strain : explanation.strains) {
    if (strain.driver != driver) continue;
    return {
        {"smallest", strain.smallest}, {"largest", strain.largest}, {"degrees", strain.degrees}};
  }
  return nullptr;
}

// The blend shapes that a driver reads, strongest first.
Json ShapesJson(const wrinkle::Explanation& explanation, const std::string& driver) {
  const auto shapes = explanation.ShapesOf(driver);
  if (shapes.empty()) return nullptr;
  Json list = Json::array();
  for (const auto* shape : shapes) {
    list.push_back({{"name", shape->blend_shape}, {"coefficient", shape->coefficient}});
  }
  return list;
}

// One source of a weight: driver value times gain, and how the driver came to its value.
Json ContributionJson(const wrinkle::Explanation& explanation, const wrinkle::Rig& rig,
                      const wrinkle::Explanation::Contribution& part) {
  const Driver* driver = FindDriver(rig, part.driver_value);
  Json json = {
      {"value", part.driver_value}, {"kind", driver == nullptr ? "" : DriverKindName(driver->kind)},
      {"reference_pose", nullptr},  {"driver_value", part.value},
      {"gain", part.gain},          {"modulated", part.modulated},
      {"product", part.product},    {"pose", PoseJson(explanation, part.driver_value)},
      {"angles", nullptr},          {"strain", nullptr},
      {"blend_shapes", nullptr}};
  if (driver != nullptr) {
    json["reference_pose"] = ReferencePoseOf(*driver, part.driver_value);
    json["angles"] = AnglesJson(explanation, driver->name);
    json["strain"] = StrainJson(explanation, driver->name);
    json["blend_shapes"] = ShapesJson(explanation, driver->name);
  }
  return json;
}

}  // namespace

ApiReply RigApi::ShowRig(const Hub& hub) const {
  const wrinkle::Rig& rig = hub.rig();
  Json regions = Json::array();
  for (const wrinkle::Region& region : rig.regions) regions.push_back(RegionJson(rig, region));
  Json drivers = Json::array();
  for (const Driver& driver : rig.drivers) drivers.push_back(DriverJson(driver, rig));
  Json poses = Json::array();
  for (const auto& pose : rig.reference_poses) poses.push_back(pose.name);
  return JsonReply({{"name", rig.name},
                    {"anchor", rig.anchor},
                    {"regions", std::move(regions)},
                    {"drivers", std::move(drivers)},
                    {"reference_poses", std::move(poses)},
                    {"captures", captures_->History(hub)},
                    {"changed", hub.has_captured_rig()}});
}

ApiReply RigApi::RigFile(const Hub& hub) const {
  return {.body = rig::RigToJson(hub.rig()), .file_name = "rig.json"};
}

ApiReply RigApi::Explain(const ApiRequest& request, Hub& hub) const {
  const std::string_view name = request.url.Value("subject");
  const Subject* subject = hub.RequireAllDrivers(name, request.access);
  if (subject == nullptr) return NoSuchSubject(hub, name, request.access);
  const SubjectPipeline& pipeline = *subject->pipeline;
  const wrinkle::RigBinding& binding = *pipeline.stream().binding;
  const std::string_view wanted = request.url.Value("weight");
  const auto names = binding.weight_names();
  const auto found = std::ranges::find(names, wanted);
  if (found == names.end()) {
    return ErrorReply(404, "not_found", "weight", "no weight '" + std::string(wanted) + "'",
                      "see /api/rig for all weights");
  }
  const auto index = static_cast<std::size_t>(found - names.begin());
  wrinkle::Explanation explanation;
  // Explains the pose without the filter, while "live" is the filtered weight that subscribers
  // receive.
  if (wrinkle::Explain(binding, pipeline.solved_pose(), &explanation) != wrinkle::JobStatus::kOk) {
    return ErrorReply(500, "internal", "", "the solver refused the pose");
  }
  const wrinkle::Explanation::Weight& weight = explanation.weights[index];
  Json contributions = Json::array();
  for (const auto& part : weight.contributions) {
    contributions.push_back(ContributionJson(explanation, binding.rig(), part));
  }
  Json conflicts = Json::array();
  for (const auto& conflict : weight.conflicts) {
    conflicts.push_back(
        {{"weight", conflict.weight}, {"other", conflict.other}, {"factor", conflict.factor}});
  }
  return JsonReply({{"subject", subject->name},
                    {"sequence", pipeline.sequence()},
                    {"weight", weight.name},
                    {"live", pipeline.wrinkle_weights()[index]},
                    {"result", weight.result},
                    {"combined", weight.combined},
                    {"modulated", weight.modulated},
                    {"modulation", weight.modulation},
                    {"contributions", std::move(contributions)},
                    {"conflicts", std::move(conflicts)}});
}

}  // namespace furrow::server
