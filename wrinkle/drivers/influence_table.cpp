// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/influence_table.h"

#include <algorithm>
#include <utility>

#include "wrinkle/weights/modulation.h"

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

std::size_t InfluenceTable::MaskOf(int map, const Mask& mask) {
  const bool smooth = mask.lambda == LambdaMode::kSmooth;
  const DynamicMask wanted{map, mask.lambda,
                           smooth ? mask.smooth_width : DynamicMask().smooth_width};
  const auto found = std::find(masks_.begin(), masks_.end(), wanted);
  const auto index = static_cast<std::size_t>(found - masks_.begin());
  if (found == masks_.end()) masks_.push_back(wanted);
  return index;
}

void InfluenceTable::Bind(const Rig& rig, const Skeleton& skeleton,
                          const std::unordered_map<std::string, int>& value_index) {
  std::vector<std::pair<int, std::size_t>> places;  // of each entry: joint, mask
  for (const Region& region : rig.regions) {
    if (region.mask.kind != Mask::Kind::kSkinning) continue;
    for (const Feed& feed : region.feeds) {
      const std::size_t map = IndexByName(rig.wrinkle_maps, feed.map);
      if (map == rig.wrinkle_maps.size()) continue;
      const std::size_t mask = MaskOf(static_cast<int>(map), region.mask);
      for (const Feed::Source& source : feed.sources) {
        const Driver& driver = rig.drivers[IndexByName(rig.drivers, source.driver)];
        for (const std::string& name : ConcernedJoints(driver)) {
          const int joint = skeleton.Find(name);
          if (joint == kNoJoint) continue;
          places.emplace_back(joint, mask);
          entries_.push_back({.driver_value = value_index.at(source.driver + "." + source.value),
                              .gain = source.gain,
                              .modulation = region.modulation});
        }
      }
    }
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const auto& [joint, mask] = places[i];
    entries_[i].place =
        static_cast<std::uint32_t>(static_cast<std::size_t>(joint) * masks_.size() + mask);
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
