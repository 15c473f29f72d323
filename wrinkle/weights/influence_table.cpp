// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/influence_table.h"

#include <algorithm>

#include "base/scalar.h"

namespace furrow::wrinkle {
namespace {

template <class Item>
std::size_t IndexByName(const std::vector<Item>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return static_cast<std::size_t>(found - items.begin());
}

}  // namespace

std::size_t InfluenceTable::MaskOf(int map, const Mask& mask) {
  // Only kSmooth reads the width. Other modes get the default, so that they share a mask.
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
  std::vector<Entry> entries;
  for (const Region& region : rig.regions) {
    if (region.mask.kind != Mask::Kind::kSkinning) continue;
    for (const Feed& feed : region.feeds) {
      const std::size_t map = IndexByName(rig.wrinkle_maps, feed.map);
      if (map == rig.wrinkle_maps.size()) continue;
      const std::size_t mask = MaskOf(static_cast<int>(map), region.mask);
      const FeedModulation modulation = ModulationOf(rig, region, feed);
      for (const Feed::Source& source : feed.sources) {
        const Driver& driver = rig.drivers[IndexByName(rig.drivers, source.driver)];
        const std::vector<std::string> joints =
            VisitFields(driver, [](const auto& fields) { return JointsInfluenced(fields); });
        for (const std::string& name : joints) {
          const int joint = skeleton.Find(name);
          if (joint == kNoJoint) continue;
          entries.push_back({.joint = static_cast<std::size_t>(joint),
                             .mask = mask,
                             .driver_value = value_index.at(source.driver + "." + source.value),
                             .gain = source.gain,
                             .modulation = modulation});
        }
      }
    }
  }
  // Sixteen entries per block, because the kernel modulates a row at a time.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t lane = i % kRowLanes;
    if (lane == 0) blocks_.emplace_back();
    Block& block = blocks_.back();
    block.num_lanes = lane + 1;
    block.places[lane] = entries[i].joint * masks_.size() + entries[i].mask;
    block.driver_values[lane] = entries[i].driver_value;
    block.gains[lane] = entries[i].gain;
    block.modulation.Set(entries[i].modulation, lane);
  }
}

std::vector<std::size_t> InfluenceTable::Places() const {
  std::vector<std::size_t> places;
  for (const Block& block : blocks_) {
    places.insert(places.end(), block.places.begin(),
                  block.places.begin() + static_cast<std::ptrdiff_t>(block.num_lanes));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void InfluenceTable::Evaluate(std::span<const float> driver_values, ModulateRow* modulate,
                              std::span<float> influences) const {
  std::fill(influences.begin(), influences.end(), 0.0f);
  for (const Block& block : blocks_) {
    FloatRow row;
    for (std::size_t lane = 0; lane < block.num_lanes; ++lane) {
      row.at[lane] = Saturate(block.gains[lane] * driver_values[block.driver_values[lane]]);
    }
    modulate(block.modulation, row.at);
    for (std::size_t lane = 0; lane < block.num_lanes; ++lane) {
      float& influence = influences[block.places[lane]];
      influence = std::max(influence, row.at[lane]);
    }
  }
}

}  // namespace furrow::wrinkle
