// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <glm/geometric.hpp>

#include "base/ascii.h"
#include "wrinkle/fields/field_check.h"
#include "wrinkle/fields/rig_field.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {
namespace {

void CheckReferencePose(const ReferencePose& pose, const std::string& at, FieldCheck* check) {
  check->Range(at, ".source_size", pose.source_size, 0.0f, kMaxSkeletonSize);
  check->Count(at, ".joints", pose.joints.size(), kMaxJoints);
  std::unordered_set<std::string_view> joints;
  for (std::size_t i = 0; i < pose.joints.size(); ++i) {
    const JointDelta& delta = pose.joints[i];
    const std::string joint = FieldAt(at + ".joints", i);
    check->Label(joint, ".joint", delta.joint);
    check->Once(joint, ".joint", delta.joint, &joints);
    check->Finite(joint, ".translation", delta.translation);
    check->Finite(joint, ".translation", delta.unscaled_translation);
    check->Finite(joint, ".rotation", delta.rotation);
    check->Require(std::abs(glm::length(delta.rotation) - 1.0f) <= 1e-3f, joint, ".rotation",
                   "the rotation is not a unit quaternion",
                   "write [x, y, z, w] of length 1, or euler_degrees");
  }
  check->Count(at, ".shapes", pose.shapes.size(), kMaxPoseShapes);
  std::unordered_set<std::string> shapes;
  for (std::size_t i = 0; i < pose.shapes.size(); ++i) {
    const std::string shape = FieldAt(at + ".shapes", i);
    check->Label(shape, ".blend_shape", pose.shapes[i].blend_shape);
    check->Require(shapes.insert(AsciiLower(pose.shapes[i].blend_shape)).second, shape,
                   ".blend_shape", "the blend shape occurs twice");
    check->Range(shape, ".value", pose.shapes[i].value, -kMaxCoefficient, kMaxCoefficient);
  }
}

void CheckSizeReference(const SizeReference& reference, FieldCheck* check) {
  const std::string at = "size_reference";
  check->Range(at, ".size", reference.size, 0.0f, kMaxSkeletonSize);
  check->Require(reference.size > 0.0f, at, ".size", "the size must be above 0");
  check->Require(reference.joints.size() > 1, at, ".joints", "a size needs at least two joints");
  check->Count(at, ".joints", reference.joints.size(), kMaxJoints);
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < reference.joints.size(); ++i) {
    const std::string joint = FieldAt(at + ".joints", i);
    check->Label(joint, ".joint", reference.joints[i].name);
    check->Once(joint, ".joint", reference.joints[i].name, &names);
    check->Finite(joint, ".position", reference.joints[i].position);
  }
}

void CheckDriver(const Driver& driver, const std::string& at, FieldCheck* check) {
  const std::string fields = at + "." + std::string(DriverKindName(driver.kind));
  VisitFields(driver, [&](const auto& kind) { CheckFields(kind, fields, check); });
}

// `curve`: of a region or of a feed; empty if a named modulation counts.
void CheckCurve(const std::vector<CurvePoint>& curve, const std::string& at, FieldCheck* check) {
  if (curve.empty()) return;
  check->Require(curve.size() > 1, at, ".curve", "a curve needs at least two points");
  check->Count(at, ".curve", curve.size(), kMaxCurvePoints);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::string point = FieldAt(at + ".curve", i);
    check->Range(point, "[0]", curve[i].x, 0.0f, 1.0f);
    check->Range(point, "[1]", curve[i].y, 0.0f, 1.0f);
    // A step of 0.01 between decimal numbers may be a little shorter as floats.
    check->Require(i == 0 || curve[i].x - curve[i - 1].x > 0.999f * kLeastCurveStep, point, "[0]",
                   "x must rise by at least 0.01 from point to point");
  }
}

// A driver that the rig lacks is reported when the name is resolved.
bool ReadsAngle(const Rig& rig, const Feed::Source& source) {
  const auto driver = std::ranges::find(rig.drivers, source.driver, &Driver::name);
  return driver == rig.drivers.end() || DriverValueAtAngle(*driver, source.value, 0.0f).has_value();
}

void CheckAngles(const Feed& feed, const std::string& at, const Rig& rig, FieldCheck* check) {
  if (feed.angles.empty()) return;
  check->Require(feed.angles.size() > 1, at, ".angles", "a curve needs at least two points");
  check->Count(at, ".angles", feed.angles.size(), kMaxCurvePoints);
  for (std::size_t i = 0; i < feed.angles.size(); ++i) {
    const std::string point = FieldAt(at + ".angles", i);
    check->Range(point, "[0]", feed.angles[i].x, 0.0f, 180.0f);
    check->Range(point, "[1]", feed.angles[i].y, 0.0f, 1.0f);
    check->Require(i == 0 || feed.angles[i].x - feed.angles[i - 1].x >= kLeastAngleStep, point,
                   "[0]", "the angle must rise by at least 2 degrees from point to point");
  }
  check->Require(!feed.sources.empty() && ReadsAngle(rig, feed.sources.front()), at, ".angles",
                 "the first source has no angle", "name a hinge, a ball or a twist first");
  check->Require(feed.sources.empty() || feed.sources.front().gain > 0.0f, at, ".angles",
                 "the first source has a gain of 0, so it states no angle");
}

// Gains are not negative, so a sum of 0 means that all of them are 0.
void CheckFeed(const Feed& feed, const std::string& at, Combine combine, const Rig& rig,
               FieldCheck* check) {
  check->Require(!feed.sources.empty(), at, ".sources", "a feed needs a source");
  check->Count(at, ".sources", feed.sources.size(), kMaxSources);
  CheckCurve(feed.curve, at, check);
  CheckAngles(feed, at, rig, check);
  float gains = 0.0f;
  for (std::size_t i = 0; i < feed.sources.size(); ++i) {
    const float gain = feed.sources[i].gain;
    check->Range(FieldAt(at + ".sources", i), ".gain", gain, 0.0f, 100.0f);
    gains += gain;
  }
  check->Require(combine != Combine::kMean || gains > 0.0f, at, ".sources",
                 "all gains are 0, which leaves no mean");
}

void CheckRegion(const Region& region, const std::string& at, const Rig& rig, FieldCheck* check) {
  check->Require(region.mask.channel >= 0 && region.mask.channel <= 3, at, ".mask.channel",
                 "a picture has no such channel", "use 0, 1, 2 or 3 (red, green, blue or alpha)");
  check->Range(at, ".mask.smooth_width", region.mask.smooth_width, 1e-4f, 1.0f);
  check->Range(at, ".mask.spread_degrees", region.mask.spread_degrees, 1.0f, 180.0f);
  check->Range(at, ".mask.above", region.mask.above, 0.0f, 10.0f);
  check->Range(at, ".mask.below", region.mask.below, 0.0f, 10.0f);
  check->Range(at, ".mask.radius", region.mask.radius, 1e-3f, 10.0f);
  check->Require(region.mask.above + region.mask.below > 0.0f, at, ".mask.below",
                 "the mask has no length: above and below are 0");
  CheckCurve(region.curve, at, check);
  check->Count(at, ".neighbours", region.neighbours.size(), kMaxRegions);
  check->Count(at, ".feeds", region.feeds.size(), kMaxWrinkleMaps);
  std::unordered_set<std::string_view> maps;
  for (std::size_t i = 0; i < region.feeds.size(); ++i) {
    const std::string feed = FieldAt(at + ".feeds", i);
    check->Name(feed, ".map", region.feeds[i].map);
    check->Once(feed, ".map", region.feeds[i].map, &maps);
    CheckFeed(region.feeds[i], feed, region.combine, rig, check);
  }
}

void CheckMap(const WrinkleMap& map, const std::string& at, FieldCheck* check) {
  check->Range(at, ".amplitude", map.amplitude, 0.0f, 100.0f);
  check->Range(at, ".derivative_scale", map.derivative_scale, 1e-4f, kMaxDerivativeScale);
  check->Range(at, ".height_mm", map.height_mm, 1e-4f, 1000.0f);
  check->Range(at, ".colour_scale", map.colour_scale, 0.1f, 10.0f);
  check->Require(map.opposes != map.name, at, ".opposes", "a map cannot oppose itself");
}

void CheckFilter(const Filter& filter, FieldCheck* check) {
  const std::string at = "filter";
  check->Range(at, ".min_cutoff_hz", filter.min_cutoff_hz, 1e-3f, 1000.0f);
  check->Range(at, ".beta", filter.beta, 0.0f, 1000.0f);
  check->Range(at, ".derivative_cutoff_hz", filter.derivative_cutoff_hz, 1e-3f, 1000.0f);
  check->Range(at, ".slew_per_second", filter.slew_per_second, 0.0f, 1e6f);
  check->Range(at, ".hold_seconds", filter.hold_seconds, 0.0f, 3600.0f);
  check->Range(at, ".decay_seconds", filter.decay_seconds, 0.0f, 3600.0f);
}

// Checks a list of at most `most` items: each has a unique name that passes `check_name`, and
// passes `check_item`.
template <class Item, class CheckItem>
void CheckList(const std::string& list, const std::vector<Item>& items, std::size_t most,
               void (FieldCheck::*check_name)(const std::string&, std::string_view,
                                              std::string_view),
               CheckItem check_item, FieldCheck* check) {
  check->Count(list, "", items.size(), most);
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string at = FieldAt(list, i);
    (check->*check_name)(at, ".name", items[i].name);
    check->Once(at, ".name", items[i].name, &names);
    check_item(items[i], at, check);
  }
}

// Why a driver cannot move a sliding mask; null if it has a direction.
const char* WhyNoDirection(const BallDriver&) { return nullptr; }
const char* WhyNoDirection(const TwistDriver&) { return nullptr; }
const char* WhyNoDirection(const HingeDriver& driver) {
  return driver.axis ? nullptr : "a hinge without an axis has no direction";
}
template <class Kind>
const char* WhyNoDirection(const Kind&) {
  return "this kind of driver has no direction";
}

void CheckSlides(const Rig& rig, FieldCheck* check) {
  for (std::size_t i = 0; i < rig.regions.size(); ++i) {
    const Mask& mask = rig.regions[i].mask;
    if (mask.kind != Mask::Kind::kSliding) continue;
    const auto driver = std::find_if(rig.drivers.begin(), rig.drivers.end(),
                                     [&](const Driver& d) { return d.name == mask.driver; });
    const char* const wrong =
        driver == rig.drivers.end()
            ? "a sliding mask names a driver of the rig"
            : VisitFields(*driver, [](const auto& fields) { return WhyNoDirection(fields); });
    check->Require(wrong == nullptr, FieldAt("regions", i), ".mask.driver",
                   wrong == nullptr ? "" : wrong,
                   "name a ball driver, a twist driver, or a hinge driver with an axis");
  }
}

}  // namespace

Status CheckRigFields(const Rig& rig) {
  FieldCheck check;
  if (rig.size_reference != nullptr) CheckSizeReference(*rig.size_reference, &check);
  CheckList("reference_poses", rig.reference_poses, kMaxReferencePoses, &FieldCheck::Label,
            CheckReferencePose, &check);
  CheckList("drivers", rig.drivers, kMaxRigDrivers, &FieldCheck::Name, CheckDriver, &check);
  CheckList("wrinkle_maps", rig.wrinkle_maps, kMaxWrinkleMaps, &FieldCheck::Name, CheckMap, &check);
  CheckList(
      "regions", rig.regions, kMaxRegions, &FieldCheck::Name,
      [&](const Region& region, const std::string& at, FieldCheck* fields) {
        CheckRegion(region, at, rig, fields);
      },
      &check);
  CheckSlides(rig, &check);
  CheckFilter(rig.filter, &check);
  return check.Take();
}

}  // namespace furrow::wrinkle
