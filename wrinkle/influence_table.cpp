// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/influence_table.h"

#include <algorithm>

#include "wrinkle/modulation.h"

namespace furrow::wrinkle {
namespace {

std::vector<std::string> ConcernedJoints(const Driver& driver) {
  std::vector<std::string> names;
  switch (driver.kind) {
    case Driver::Kind::kPose:
      for (const ControlPoint& point : driver.pose.points) names.push_back(point.joint);
      break;
    case Driver::Kind::kHinge: names.push_back(driver.hinge.joint); break;
    case Driver::Kind::kBall: names.push_back(driver.ball.joint); break;
    case Driver::Kind::kTwist:
      names = driver.twist.through;
      names.push_back(driver.twist.joint);
      break;
    case Driver::Kind::kStrain: names = driver.strain.joints; break;
    case Driver::Kind::kBlendShape: break;
  }
  return names;
}

template <class Item>
std::size_t IndexByName(const std::vector<Item>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return static_cast<std::size_t>(found - items.begin());
}

}  // namespace

void InfluenceTable::Bind(const Rig& rig, const Skeleton& skeleton,
                          const std::unordered_map<std::string, int>& value_index) {
  const std::size_t num_maps = rig.wrinkle_maps.size();
  for (const Region& region : rig.regions) {
    if (region.mask.kind != Mask::Kind::kSkinning) continue;
    for (const Feed& feed : region.feeds) {
      const std::size_t map = IndexByName(rig.wrinkle_maps, feed.map);
      if (map == num_maps) continue;
      for (const Feed::Source& source : feed.sources) {
        const Driver& driver = rig.drivers[IndexByName(rig.drivers, source.driver)];
        for (const std::string& name : ConcernedJoints(driver)) {
          const int joint = skeleton.Find(name);
          if (joint == kNoJoint) continue;
          entries_.push_back({.place = static_cast<std::uint32_t>(
                                  static_cast<std::size_t>(joint) * num_maps + map),
                              .driver_value = value_index.at(source.driver + "." + source.value),
                              .gain = source.gain,
                              .modulation = region.modulation});
        }
      }
    }
  }
}

void InfluenceTable::Evaluate(std::span<const float> driver_values,
                              std::span<float> influences) const {
  std::fill(influences.begin(), influences.end(), 0.0f);
  for (const Entry& entry : entries_) {
    const float influence =
        Modulate(entry.modulation, entry.gain * driver_values[entry.driver_value]);
    influences[entry.place] = std::max(influences[entry.place], influence);
  }
}

}  // namespace furrow::wrinkle
