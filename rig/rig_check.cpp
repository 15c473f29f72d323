// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_check.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/asset_path.h"
#include "base/joined.h"
#include "base/status.h"
#include "wrinkle/fields/rig_field.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::rig {
namespace {

using wrinkle::Driver;
using wrinkle::FieldAt;
using wrinkle::InvalidField;
using wrinkle::Region;
using wrinkle::Rig;

// Views into the rig, which outlives the checker.
template <class Item>
std::unordered_set<std::string_view> NamesOf(const std::vector<Item>& items) {
  std::unordered_set<std::string_view> names;
  for (const Item& item : items) names.insert(item.name);
  return names;
}

// Checks the references between the fields of a rig, and the names of its files.
class References {
 public:
  explicit References(const Rig& rig)
      : rig_(rig),
        poses_(NamesOf(rig.reference_poses)),
        maps_(NamesOf(rig.wrinkle_maps)),
        regions_(NamesOf(rig.regions)) {}

  Status Check() {
    // The order matters: feeds refer to the values that CheckDrivers() lists, exports refer to the
    // weights that CheckFeeds() lists.
    FURROW_RETURN_IF_ERROR(CheckDrivers());
    for (std::size_t i = 0; i < rig_.wrinkle_maps.size(); ++i) {
      FURROW_RETURN_IF_ERROR(CheckMap(rig_.wrinkle_maps[i], FieldAt("wrinkle_maps", i)));
    }
    for (std::size_t i = 0; i < rig_.regions.size(); ++i) {
      const Region& region = rig_.regions[i];
      const std::string at = FieldAt("regions", i);
      FURROW_RETURN_IF_ERROR(CheckMask(region.mask, at + ".mask"));
      FURROW_RETURN_IF_ERROR(CheckFeeds(region, at + ".feeds"));
      FURROW_RETURN_IF_ERROR(CheckNeighbours(region, at + ".neighbours"));
    }
    return CheckExports();
  }

 private:
  Status CheckDrivers() {
    for (std::size_t i = 0; i < rig_.drivers.size(); ++i) {
      const Driver& driver = rig_.drivers[i];
      driver_values_[driver.name] = wrinkle::DriverValueNames(driver);
      if (driver.kind != Driver::Kind::kPose) continue;
      const std::string values = FieldAt("drivers", i) + ".pose.values";
      for (std::size_t k = 0; k < driver.pose.values.size(); ++k) {
        const std::string& pose = driver.pose.values[k].reference_pose;
        if (poses_.contains(pose)) continue;
        return InvalidField("there is no reference pose '" + pose + "'",
                            FieldAt(values, k) + ".reference_pose", "name one of reference_poses");
      }
    }
    return {};
  }

  Status CheckMap(const wrinkle::WrinkleMap& map, const std::string& at) {
    const std::pair<const std::string*, const char*> files[] = {{&map.normal, ".normal"},
                                                                {&map.derivative, ".derivative"},
                                                                {&map.height, ".height"},
                                                                {&map.colour, ".colour"},
                                                                {&map.cavity, ".cavity"}};
    for (const auto& [file, field] : files) {
      // Checks the name only. The file may be missing: weights need no pictures.
      if (file->empty()) continue;
      if (Status s = CheckAssetName(*file); !s.ok()) return s.At(at + field);
    }
    // Both state the same slopes, so one would have to be ignored silently.
    if (!map.normal.empty() && !map.derivative.empty()) {
      return InvalidField("a map cannot have both a normal map and a derivative map",
                          at + ".derivative");
    }
    if (!map.opposes.empty() && !maps_.contains(map.opposes)) {
      return InvalidField("there is no wrinkle map '" + map.opposes + "'", at + ".opposes");
    }
    return {};
  }

  static Status CheckMask(const wrinkle::Mask& mask, const std::string& at) {
    if (mask.kind != wrinkle::Mask::Kind::kTexture) return {};
    return CheckAssetName(mask.texture).At(at + ".texture");
  }

  Status CheckFeeds(const Region& region, const std::string& list) {
    if (region.feeds.empty()) return InvalidField("a region needs at least one feed", list);
    // Fields are named "<list>[<index>].<field>", the paths that CheckedJson::Located() knows.
    for (std::size_t i = 0; i < region.feeds.size(); ++i) {
      const wrinkle::Feed& feed = region.feeds[i];
      const std::string at = FieldAt(list, i);
      if (!maps_.contains(feed.map)) {
        return InvalidField("there is no wrinkle map '" + feed.map + "'", at + ".map",
                            "name one of wrinkle_maps");
      }
      for (std::size_t k = 0; k < feed.sources.size(); ++k) {
        FURROW_RETURN_IF_ERROR(CheckSource(feed.sources[k], FieldAt(at + ".sources", k)));
      }
      weights_.insert(region.name + "." + feed.map);
    }
    return {};
  }

  Status CheckSource(const wrinkle::Feed::Source& source, const std::string& at) {
    const auto driver = driver_values_.find(source.driver);
    if (driver == driver_values_.end()) {
      return InvalidField("there is no driver '" + source.driver + "'", at + ".from",
                          "write \"<driver>.<value>\"");
    }
    const auto& values = driver->second;
    if (std::find(values.begin(), values.end(), source.value) == values.end()) {
      return InvalidField("driver '" + source.driver + "' has no value '" + source.value + "'",
                          at + ".from", "its values are " + Joined(values));
    }
    return {};
  }

  Status CheckNeighbours(const Region& region, const std::string& list) {
    for (std::size_t i = 0; i < region.neighbours.size(); ++i) {
      const std::string& name = region.neighbours[i];
      if (name == region.name)
        return InvalidField("a region cannot be its own neighbour", FieldAt(list, i));
      if (!regions_.contains(name))
        return InvalidField("there is no region '" + name + "'", FieldAt(list, i));
    }
    return {};
  }

  Status CheckExports() {
    const auto& exports = rig_.exports;
    if (exports.size() > kMaxExports) {
      return {StatusCode::kLimit, "more than " + std::to_string(kMaxExports) + " names", "export"};
    }
    // The file groups the exports by profile.
    int group = -1;
    int place = 0;
    for (std::size_t i = 0; i < exports.size(); ++i) {
      const bool first = i == 0 || exports[i].profile != exports[i - 1].profile;
      group += first ? 1 : 0;
      place = first ? 0 : place + 1;
      const std::string profile = FieldAt("export", static_cast<std::size_t>(group));
      const std::string at = FieldAt(profile + ".names", static_cast<std::size_t>(place));
      FURROW_RETURN_IF_ERROR(wrinkle::CheckName(exports[i].profile, profile + ".profile"));
      if (!weights_.contains(exports[i].weight)) {
        return InvalidField("there is no wrinkle weight '" + exports[i].weight + "'",
                            at + ".weight", "write \"<region>.<map>\"");
      }
      FURROW_RETURN_IF_ERROR(wrinkle::CheckLabel(exports[i].name, at + ".name"));
    }
    return {};
  }

  const Rig& rig_;
  const std::unordered_set<std::string_view> poses_;
  const std::unordered_set<std::string_view> maps_;
  const std::unordered_set<std::string_view> regions_;
  std::unordered_map<std::string_view, std::vector<std::string>> driver_values_;
  std::unordered_set<std::string> weights_;
};

}  // namespace

Status CheckRig(const Rig& rig) {
  FURROW_RETURN_IF_ERROR(wrinkle::CheckLabel(rig.name, "name"));
  if (!rig.anchor.empty()) {
    FURROW_RETURN_IF_ERROR(wrinkle::CheckLabel(rig.anchor, "anchor"));
  }
  // References are looked up by name, so names must be valid and unique first.
  FURROW_RETURN_IF_ERROR(wrinkle::CheckRigFields(rig));
  return References(rig).Check();
}

}  // namespace furrow::rig
