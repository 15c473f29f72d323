// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig_check.h"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_set>

#include <glm/geometric.hpp>

#include "wrinkle/finite.h"
#include "wrinkle/nnls.h"
#include "wrinkle/pose_driver.h"

namespace furrow::wrinkle {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();

// Collects the first complaint about one driver, region or other named thing.
class Complaints {
 public:
  explicit Complaints(std::string whose) : whose_(std::move(whose)) {}

  void Range(std::string_view field, float value, float low, float high) {
    if (!std::isfinite(value)) {
      Set(StatusCode::kNonFinite, field, "is not finite");
    } else if (value < low || value > high) {
      const std::string bounds =
          high == kMax ? "at least " + Text(low) : "in [" + Text(low) + ", " + Text(high) + "]";
      Set(StatusCode::kInvalidArgument, field, "is " + Text(value) + "; it must be " + bounds);
    }
  }
  void Finite(std::string_view field, const glm::vec3& v) {
    if (!AllFinite(v)) Set(StatusCode::kNonFinite, field, "is not finite");
  }
  void NotZero(std::string_view field, const glm::vec3& v) {
    Finite(field, v);
    if (!(glm::length(v) > 1e-6f)) Set(StatusCode::kInvalidArgument, field, "has no length");
  }
  void Count(std::string_view field, std::size_t count, std::size_t least, std::size_t most) {
    if (count < least) Set(StatusCode::kInvalidArgument, field, "is empty");
    if (count > most) {
      Set(StatusCode::kLimit, field,
          "has " + std::to_string(count) + " entries; at most " + std::to_string(most) +
              " are accepted");
    }
  }
  void Require(bool holds, std::string_view field, std::string_view otherwise) {
    if (!holds) Set(StatusCode::kInvalidArgument, field, otherwise);
  }
  [[nodiscard]] Status Take() { return std::move(first_); }

 private:
  static std::string Text(float value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }
  void Set(StatusCode code, std::string_view field, std::string_view what) {
    if (!first_.ok()) return;
    first_ = Status(code, whose_ + ": " + std::string(field) + " " + std::string(what));
  }
  std::string whose_;
  Status first_;
};

Status CheckName(std::string_view kind, const std::string& name,
                 std::unordered_set<std::string>* seen) {
  if (name.empty()) {
    return {StatusCode::kInvalidArgument, "a " + std::string(kind) + " has no name"};
  }
  if (seen->insert(name).second) return {};
  return {StatusCode::kInvalidArgument,
          "two " + std::string(kind) + "s have the name '" + name + "'"};
}

Status CheckReferencePose(const ReferencePose& pose) {
  Complaints complaints("reference pose '" + pose.name + "'");
  complaints.Range("source_size", pose.source_size, 0.0f, kMax);
  for (const JointDelta& delta : pose.joints) {
    complaints.Finite("translation of '" + delta.joint + "'", delta.translation);
    complaints.Range("length of the rotation of '" + delta.joint + "'", glm::length(delta.rotation),
                     0.999f, 1.001f);
  }
  return complaints.Take();
}

void CheckPose(const PoseDriver& pose, Complaints* complaints) {
  const bool nnls = pose.solve == PoseSolve::kNnls;
  complaints->Count("points", pose.points.size(), 1, kMaxControlPoints);
  complaints->Count("values", pose.values.size(), 1, nnls ? kMaxNnlsValues : kMaxPoseValues);
  complaints->Range("falloff", pose.falloff, 0.0f, kMax);
  for (const ControlPoint& point : pose.points) {
    complaints->Finite("offset", point.offset);
    complaints->Range("offset_size", point.offset_size, 0.0f, kMax);
  }
  std::unordered_set<std::string_view> names;
  for (const PoseDriver::Value& value : pose.values) {
    complaints->Require(!value.name.empty(), "values", "hold one without a name");
    complaints->Require(names.insert(value.name).second, "values",
                        "hold '" + value.name + "' twice");
  }
}

Status CheckDriver(const Driver& driver) {
  Complaints complaints("driver '" + driver.name + "'");
  switch (driver.kind) {
    case Driver::Kind::kPose: CheckPose(driver.pose, &complaints); break;
    case Driver::Kind::kHinge:
      if (driver.hinge.axis) complaints.NotZero("axis", *driver.hinge.axis);
      complaints.Range("beta_degrees", driver.hinge.beta_degrees, 0.0f, kMaxBetaDegrees);
      break;
    case Driver::Kind::kBall:
      complaints.Finite("bone", driver.ball.bone);
      complaints.NotZero("forward", driver.ball.forward);
      complaints.Range("beta_degrees", driver.ball.beta_degrees, 0.0f, kMaxBetaDegrees);
      break;
    case Driver::Kind::kTwist:
      if (driver.twist.axis) complaints.NotZero("axis", *driver.twist.axis);
      complaints.Range("full_degrees", driver.twist.full_degrees, 1.0f, 180.0f);
      break;
    case Driver::Kind::kBlendShape: {
      const BlendShapeDriver& shape = driver.blend_shape;
      complaints.Range("neutral", shape.neutral, -kMax, kMax);
      complaints.Range("full", shape.full, -kMax, kMax);
      complaints.Require(std::abs(shape.full - shape.neutral) >= 1e-4f, "full",
                         "is the same coefficient as neutral");
      break;
    }
  }
  return complaints.Take();
}

Status CheckRegion(const Region& region) {
  Complaints complaints("region '" + region.name + "'");
  complaints.Range("channel", static_cast<float>(region.mask.channel), 0.0f, 3.0f);
  complaints.Range("smooth_width", region.mask.smooth_width, 1e-4f, 1.0f);
  std::unordered_set<std::string_view> maps;
  for (const Feed& feed : region.feeds) {
    complaints.Require(!feed.map.empty(), "feeds", "hold one without a map");
    complaints.Require(maps.insert(feed.map).second, "feeds", "hold map '" + feed.map + "' twice");
    complaints.Count("sources of '" + feed.map + "'", feed.sources.size(), 1, kMaxWeights);
    float gains = 0.0f;
    for (const Feed::Source& source : feed.sources) {
      complaints.Range("gain of '" + source.driver + "." + source.value + "'", source.gain, 0.0f,
                       100.0f);
      gains += source.gain;
    }
    complaints.Require(region.combine != Combine::kMean || gains > 0.0f,
                       "gains of '" + feed.map + "'", "are all 0, which leaves no mean");
  }
  return complaints.Take();
}

Status CheckFilter(const Filter& filter) {
  Complaints complaints("filter");
  complaints.Range("min_cutoff_hz", filter.min_cutoff_hz, 1e-3f, 1000.0f);
  complaints.Range("beta", filter.beta, 0.0f, 1000.0f);
  complaints.Range("derivative_cutoff_hz", filter.derivative_cutoff_hz, 1e-3f, 1000.0f);
  complaints.Range("slew_per_second", filter.slew_per_second, 0.0f, kMax);
  complaints.Range("hold_seconds", filter.hold_seconds, 0.0f, 3600.0f);
  complaints.Range("decay_seconds", filter.decay_seconds, 0.0f, 3600.0f);
  return complaints.Take();
}

Status CheckMap(const WrinkleMap& map) {
  Complaints complaints("wrinkle map '" + map.name + "'");
  complaints.Range("amplitude", map.amplitude, 0.0f, 100.0f);
  complaints.Require(map.opposes != map.name, "opposes", "names the map itself");
  return complaints.Take();
}

// Every item has a name of its own and passes `check`.
template <class Item, class Check>
Status CheckAll(std::string_view kind, const std::vector<Item>& items, Check check) {
  std::unordered_set<std::string> names;
  for (const Item& item : items) {
    if (Status status = CheckName(kind, item.name, &names); !status.ok()) return status;
    if (Status status = check(item); !status.ok()) return status;
  }
  return {};
}

}  // namespace

Status CheckRigNumbers(const Rig& rig) {
  if (Status s = CheckAll("reference pose", rig.reference_poses, CheckReferencePose); !s.ok()) {
    return s;
  }
  if (Status s = CheckAll("driver", rig.drivers, CheckDriver); !s.ok()) return s;
  if (Status s = CheckAll("wrinkle map", rig.wrinkle_maps, CheckMap); !s.ok()) return s;
  if (Status s = CheckAll("region", rig.regions, CheckRegion); !s.ok()) return s;
  std::size_t num_weights = 0;
  for (const Region& region : rig.regions) num_weights += region.feeds.size();
  if (num_weights > static_cast<std::size_t>(kMaxWeights)) {
    return {StatusCode::kLimit, "the rig has " + std::to_string(num_weights) +
                                    " wrinkle weights; at most " + std::to_string(kMaxWeights) +
                                    " are accepted"};
  }
  return CheckFilter(rig.filter);
}

}  // namespace furrow::wrinkle
