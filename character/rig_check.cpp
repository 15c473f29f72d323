// SPDX-License-Identifier: Apache-2.0
#include "character/rig_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "character/asset_path.h"

namespace furrow::character {
namespace {

using wrinkle::Driver;
using wrinkle::Region;
using wrinkle::Rig;

constexpr std::size_t kMaxNameBytes = 255;

std::string At(std::string_view list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

Status Invalid(std::string what, std::string where, std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), std::move(where), std::move(todo)};
}

Status CheckCount(std::size_t count, std::size_t limit, const std::string& where) {
  if (count <= limit) return {};
  return {StatusCode::kLimit,
          std::to_string(count) + " entries, at most " + std::to_string(limit) + " are read",
          where};
}

// Joints and poses: any text that can be printed.
Status CheckLabel(std::string_view name, const std::string& where) {
  if (name.empty()) return Invalid("the name is empty", where);
  if (name.size() > kMaxNameBytes) {
    return {StatusCode::kLimit, "the name is longer than 255 bytes", where};
  }
  const bool printable = std::all_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  });
  return printable ? Status() : Invalid("the name holds a control byte", where);
}

// Drivers, values, regions and maps: their names make up weight names, which stand in CSV headers,
// patterns and OSC addresses.
Status CheckName(std::string_view name, const std::string& where) {
  if (Status status = CheckLabel(name, where); !status.ok()) return status;
  if (name.find_first_of(" .,;:*?\"'/\\[]{}#") != std::string_view::npos) {
    return Invalid("the name '" + std::string(name) +
                       "' holds a blank or one of . , ; : * ? / # or "
                       "a quote or bracket",
                   where, "use letters, digits, '_' and '-'");
  }
  return {};
}

Status CheckRange(float value, float low, float high, const std::string& where) {
  if (!std::isfinite(value)) return {StatusCode::kNonFinite, "the number is not finite", where};
  if (value >= low && value <= high) return {};
  const auto text = [](float f) {
    std::string s = std::to_string(f);
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    return s;
  };
  return Invalid(text(value) + " is out of range [" + text(low) + ", " + text(high) + "]", where);
}

Status CheckFinite(const glm::vec3& v, const std::string& where) {
  if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) return {};
  return {StatusCode::kNonFinite, "the vector is not finite", where};
}

Status CheckDirection(const glm::vec3& v, const std::string& where) {
  if (Status status = CheckFinite(v, where); !status.ok()) return status;
  const float length = glm::length(v);
  if (length > 1e-6f && std::isfinite(length)) return {};
  return Invalid("the direction has no length", where);
}

// A list's names, with the error for a name that comes twice.
class Names {
 public:
  Status Add(std::string_view name, const std::string& where) {
    if (names_.emplace(name).second) return {};
    return Invalid("the name '" + std::string(name) + "' is given twice", where);
  }
  [[nodiscard]] bool Has(std::string_view name) const {
    return names_.count(std::string(name)) > 0;
  }

 private:
  std::unordered_set<std::string> names_;
};

// The first failure of several checks; later ones do not run.
Status FirstOf(std::initializer_list<std::function<Status()>> checks) {
  for (const auto& check : checks) {
    if (Status status = check(); !status.ok()) return status;
  }
  return {};
}

// One check of one rig: remembers the names as it goes down the file.
class Checker {
 public:
  explicit Checker(const Rig& rig) : rig_(rig) {}

  Status Run() {
    return FirstOf(
        {[&] { return CheckLabel(rig_.name, "name"); },
         [&] { return rig_.anchor.empty() ? Status() : CheckLabel(rig_.anchor, "anchor"); },
         [&] { return CheckReferencePoses(); }, [&] { return CheckDrivers(); },
         [&] { return CheckMaps(); }, [&] { return CheckRegions(); }, [&] { return CheckFilter(); },
         [&] { return CheckExports(); }});
  }

 private:
  Status CheckReferencePoses() {
    const auto& poses = rig_.reference_poses;
    if (Status s = CheckCount(poses.size(), kMaxReferencePoses, "reference_poses"); !s.ok())
      return s;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::string at = At("reference_poses", i);
      if (Status s = CheckLabel(poses[i].name, at + ".name"); !s.ok()) return s;
      if (Status s = poses_.Add(poses[i].name, at + ".name"); !s.ok()) return s;
      if (Status s = CheckRange(poses[i].source_size, 0.0f, 1e6f, at + ".source_size"); !s.ok()) {
        return s;
      }
      if (Status s = CheckJointDeltas(poses[i], at + ".joints"); !s.ok()) return s;
    }
    return {};
  }

  static Status CheckJointDeltas(const wrinkle::ReferencePose& pose, const std::string& list) {
    if (Status s = CheckCount(pose.joints.size(), 1024, list); !s.ok()) return s;
    Names names;
    for (std::size_t i = 0; i < pose.joints.size(); ++i) {
      const wrinkle::JointDelta& delta = pose.joints[i];
      const std::string at = At(list, i);
      if (Status s = CheckLabel(delta.joint, at + ".joint"); !s.ok()) return s;
      if (Status s = names.Add(delta.joint, at + ".joint"); !s.ok()) return s;
      const float length = glm::length(delta.rotation);
      if (!std::isfinite(length)) {
        return {StatusCode::kNonFinite, "the rotation is not finite", at + ".rotation"};
      }
      if (std::abs(length - 1.0f) > 1e-3f) {
        return Invalid("the rotation is not a unit quaternion", at + ".rotation",
                       "write [x, y, z, w] of length 1, or euler_degrees");
      }
      if (Status s = CheckFinite(delta.translation, at + ".translation"); !s.ok()) return s;
    }
    return {};
  }

  Status CheckDrivers() {
    const auto& drivers = rig_.drivers;
    if (Status s = CheckCount(drivers.size(), kMaxRigDrivers, "drivers"); !s.ok()) return s;
    Names names;
    for (std::size_t i = 0; i < drivers.size(); ++i) {
      const std::string at = At("drivers", i);
      if (Status s = CheckName(drivers[i].name, at + ".name"); !s.ok()) return s;
      if (Status s = names.Add(drivers[i].name, at + ".name"); !s.ok()) return s;
      if (Status s = CheckDriver(drivers[i], at); !s.ok()) return s;
      driver_values_[drivers[i].name] = DriverValueNames(drivers[i]);
    }
    return {};
  }

  Status CheckDriver(const Driver& driver, const std::string& at) {
    switch (driver.kind) {
      case Driver::Kind::kPose: return CheckPose(driver.pose, at + ".pose");
      case Driver::Kind::kHinge: return CheckHinge(driver.hinge, at + ".hinge");
      case Driver::Kind::kBall: return CheckBall(driver.ball, at + ".ball");
      case Driver::Kind::kTwist: return CheckTwist(driver.twist, at + ".twist");
      case Driver::Kind::kBlendShape:
        return CheckBlendShape(driver.blend_shape, at + ".blend_shape");
    }
    return {StatusCode::kInternal, "a driver of no known kind", at};
  }

  Status CheckPose(const wrinkle::PoseDriver& pose, const std::string& at) {
    if (pose.points.empty()) return Invalid("a pose driver needs a control point", at + ".points");
    if (pose.values.empty()) return Invalid("a pose driver needs a value", at + ".values");
    if (Status s = CheckCount(pose.points.size(), 256, at + ".points"); !s.ok()) return s;
    if (Status s = CheckCount(pose.values.size(), 64, at + ".values"); !s.ok()) return s;
    for (std::size_t i = 0; i < pose.points.size(); ++i) {
      const wrinkle::ControlPoint& point = pose.points[i];
      const std::string where = At(at + ".points", i);
      if (Status s = CheckLabel(point.joint, where + ".joint"); !s.ok()) return s;
      if (Status s = CheckFinite(point.offset, where + ".offset"); !s.ok()) return s;
      if (Status s = CheckRange(point.offset_size, 0.0f, 1e6f, where + ".offset_size"); !s.ok()) {
        return s;
      }
    }
    Names names;
    for (std::size_t i = 0; i < pose.values.size(); ++i) {
      const auto& value = pose.values[i];
      const std::string where = At(at + ".values", i);
      if (Status s = CheckName(value.name, where + ".name"); !s.ok()) return s;
      if (Status s = names.Add(value.name, where + ".name"); !s.ok()) return s;
      if (!poses_.Has(value.reference_pose)) {
        return Invalid("there is no reference pose '" + value.reference_pose + "'",
                       where + ".reference_pose", "name one of reference_poses");
      }
    }
    return CheckRange(pose.falloff, 0.0f, 1000.0f, at + ".falloff");
  }

  static Status CheckHinge(const wrinkle::HingeDriver& hinge, const std::string& at) {
    return FirstOf(
        {[&] { return CheckLabel(hinge.parent, at + ".parent"); },
         [&] { return CheckLabel(hinge.joint, at + ".joint"); },
         [&] { return hinge.axis ? CheckDirection(*hinge.axis, at + ".axis") : Status(); },
         [&] { return CheckRange(hinge.beta_degrees, 0.0f, 179.0f, at + ".beta_degrees"); }});
  }

  static Status CheckBall(const wrinkle::BallDriver& ball, const std::string& at) {
    return FirstOf(
        {[&] { return CheckLabel(ball.parent, at + ".parent"); },
         [&] { return CheckLabel(ball.joint, at + ".joint"); },
         [&] { return CheckFinite(ball.bone, at + ".bone"); },
         [&] { return CheckDirection(ball.forward, at + ".forward"); },
         [&] { return CheckRange(ball.beta_degrees, 0.0f, 179.0f, at + ".beta_degrees"); }});
  }

  static Status CheckTwist(const wrinkle::TwistDriver& twist, const std::string& at) {
    if (Status s = CheckLabel(twist.joint, at + ".joint"); !s.ok()) return s;
    if (Status s = CheckCount(twist.through.size(), 64, at + ".through"); !s.ok()) return s;
    for (std::size_t i = 0; i < twist.through.size(); ++i) {
      if (Status s = CheckLabel(twist.through[i], At(at + ".through", i)); !s.ok()) return s;
    }
    if (twist.axis) {
      if (Status s = CheckDirection(*twist.axis, at + ".axis"); !s.ok()) return s;
    }
    return CheckRange(twist.full_degrees, 1.0f, 180.0f, at + ".full_degrees");
  }

  static Status CheckBlendShape(const wrinkle::BlendShapeDriver& shape, const std::string& at) {
    if (Status s = CheckLabel(shape.blend_shape, at + ".blend_shape"); !s.ok()) return s;
    if (Status s = CheckRange(shape.neutral, -1000.0f, 1000.0f, at + ".neutral"); !s.ok()) return s;
    if (Status s = CheckRange(shape.full, -1000.0f, 1000.0f, at + ".full"); !s.ok()) return s;
    if (std::abs(shape.full - shape.neutral) >= 1e-4f) return {};
    return Invalid("full and neutral are the same coefficient", at + ".full");
  }

  Status CheckMaps() {
    const auto& maps = rig_.wrinkle_maps;
    if (Status s = CheckCount(maps.size(), kMaxWrinkleMaps, "wrinkle_maps"); !s.ok()) return s;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      const std::string where = At("wrinkle_maps", i) + ".name";
      if (Status s = CheckName(maps[i].name, where); !s.ok()) return s;
      if (Status s = maps_.Add(maps[i].name, where); !s.ok()) return s;
    }
    for (std::size_t i = 0; i < maps.size(); ++i) {
      if (Status s = CheckMap(maps[i], At("wrinkle_maps", i)); !s.ok()) return s;
    }
    return {};
  }

  Status CheckMap(const wrinkle::WrinkleMap& map, const std::string& at) {
    const std::pair<const std::string*, const char*> files[] = {{&map.normal, ".normal"},
                                                                {&map.derivative, ".derivative"},
                                                                {&map.colour, ".colour"},
                                                                {&map.cavity, ".cavity"}};
    for (const auto& [file, field] : files) {
      if (file->empty()) continue;
      if (Status s = CheckAssetName(*file); !s.ok()) return s.At(at + field);
    }
    if (!map.normal.empty() && !map.derivative.empty()) {
      return Invalid("a map has a normal map or a derivative map, not both", at + ".derivative");
    }
    if (map.opposes == map.name) return Invalid("a map cannot oppose itself", at + ".opposes");
    if (!map.opposes.empty() && !maps_.Has(map.opposes)) {
      return Invalid("there is no wrinkle map '" + map.opposes + "'", at + ".opposes");
    }
    return CheckRange(map.amplitude, 0.0f, 100.0f, at + ".amplitude");
  }

  Status CheckRegions() {
    const auto& regions = rig_.regions;
    if (Status s = CheckCount(regions.size(), kMaxRegions, "regions"); !s.ok()) return s;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const std::string where = At("regions", i) + ".name";
      if (Status s = CheckName(regions[i].name, where); !s.ok()) return s;
      if (Status s = regions_.Add(regions[i].name, where); !s.ok()) return s;
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const std::string at = At("regions", i);
      if (Status s = CheckMask(regions[i].mask, at + ".mask"); !s.ok()) return s;
      if (Status s = CheckFeeds(regions[i], at + ".feeds"); !s.ok()) return s;
      if (Status s = CheckNeighbours(regions[i], at + ".neighbours"); !s.ok()) return s;
    }
    return {};
  }

  static Status CheckMask(const wrinkle::Mask& mask, const std::string& at) {
    if (mask.kind == wrinkle::Mask::Kind::kTexture) {
      if (Status s = CheckAssetName(mask.texture); !s.ok()) return s.At(at + ".texture");
    }
    if (mask.channel < 0 || mask.channel > 3)
      return Invalid("there is no such channel", at + ".channel");
    return CheckRange(mask.smooth_width, 1e-4f, 1.0f, at + ".smooth_width");
  }

  Status CheckFeeds(const Region& region, const std::string& list) {
    if (region.feeds.empty()) return Invalid("a region needs a feed", list);
    Names maps;
    for (std::size_t i = 0; i < region.feeds.size(); ++i) {
      const wrinkle::Feed& feed = region.feeds[i];
      const std::string at = At(list, i);
      if (!maps_.Has(feed.map)) {
        return Invalid("there is no wrinkle map '" + feed.map + "'", at + ".map",
                       "name one of wrinkle_maps");
      }
      if (Status s = maps.Add(feed.map, at + ".map"); !s.ok()) return s;
      if (feed.sources.empty()) return Invalid("a feed needs a source", at + ".sources");
      if (Status s = CheckCount(feed.sources.size(), 256, at + ".sources"); !s.ok()) return s;
      for (std::size_t k = 0; k < feed.sources.size(); ++k) {
        if (Status s = CheckSource(feed.sources[k], At(at + ".sources", k)); !s.ok()) return s;
      }
      weights_.insert(region.name + "." + feed.map);
    }
    return {};
  }

  Status CheckSource(const wrinkle::Feed::Source& source, const std::string& at) {
    const auto driver = driver_values_.find(source.driver);
    if (driver == driver_values_.end()) {
      return Invalid("there is no driver '" + source.driver + "'", at + ".from",
                     "write \"<driver>.<value>\"");
    }
    const auto& values = driver->second;
    if (std::find(values.begin(), values.end(), source.value) == values.end()) {
      std::string known;
      for (const std::string& value : values) known += (known.empty() ? "" : ", ") + value;
      return Invalid("driver '" + source.driver + "' has no value '" + source.value + "'",
                     at + ".from", "its values are " + known);
    }
    return CheckRange(source.gain, 0.0f, 100.0f, at + ".gain");
  }

  Status CheckNeighbours(const Region& region, const std::string& list) {
    for (std::size_t i = 0; i < region.neighbours.size(); ++i) {
      const std::string& name = region.neighbours[i];
      if (name == region.name) return Invalid("a region is not its own neighbour", At(list, i));
      if (!regions_.Has(name)) return Invalid("there is no region '" + name + "'", At(list, i));
    }
    return {};
  }

  Status CheckFilter() {
    const wrinkle::Filter& f = rig_.filter;
    return FirstOf(
        {[&] { return CheckRange(f.min_cutoff_hz, 1e-3f, 1000.0f, "filter.min_cutoff_hz"); },
         [&] { return CheckRange(f.beta, 0.0f, 1000.0f, "filter.beta"); },
         [&] {
           return CheckRange(f.derivative_cutoff_hz, 1e-3f, 1000.0f, "filter.derivative_cutoff_hz");
         },
         [&] { return CheckRange(f.slew_per_second, 0.0f, 1e6f, "filter.slew_per_second"); },
         [&] { return CheckRange(f.hold_seconds, 0.0f, 3600.0f, "filter.hold_seconds"); },
         [&] { return CheckRange(f.decay_seconds, 0.0f, 3600.0f, "filter.decay_seconds"); }});
  }

  Status CheckExports() {
    const auto& exports = rig_.exports;
    if (Status s = CheckCount(exports.size(), kMaxExports, "export"); !s.ok()) return s;
    // In the file exports stand in groups of one profile.
    int group = -1;
    int place = 0;
    for (std::size_t i = 0; i < exports.size(); ++i) {
      const bool first = i == 0 || exports[i].profile != exports[i - 1].profile;
      group += first ? 1 : 0;
      place = first ? 0 : place + 1;
      const std::string profile = At("export", static_cast<std::size_t>(group));
      const std::string at = At(profile + ".names", static_cast<std::size_t>(place));
      if (Status s = CheckName(exports[i].profile, profile + ".profile"); !s.ok()) return s;
      if (weights_.count(exports[i].weight) == 0) {
        return Invalid("there is no wrinkle weight '" + exports[i].weight + "'", at + ".weight",
                       "write \"<region>.<map>\"");
      }
      if (Status s = CheckLabel(exports[i].name, at + ".name"); !s.ok()) return s;
    }
    return {};
  }

  const Rig& rig_;
  Names poses_;
  Names maps_;
  Names regions_;
  std::unordered_map<std::string, std::vector<std::string>> driver_values_;
  std::unordered_set<std::string> weights_;
};

}  // namespace

Status CheckRig(const Rig& rig) { return Checker(rig).Run(); }

std::vector<std::string> DriverValueNames(const Driver& driver) {
  switch (driver.kind) {
    case Driver::Kind::kHinge: return {"flexed", "extended"};
    case Driver::Kind::kBall: return {"front", "back", "left", "right"};
    case Driver::Kind::kTwist: return {"twist_left", "twist_right"};
    case Driver::Kind::kBlendShape: return {"value"};
    case Driver::Kind::kPose: break;
  }
  std::vector<std::string> names;
  for (const auto& value : driver.pose.values) names.push_back(value.name);
  return names;
}

}  // namespace furrow::character
