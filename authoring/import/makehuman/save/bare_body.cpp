// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/bare_body.h"

#include <set>
#include <string>

namespace furrow::authoring {
namespace {

using wrinkle::WrinkleMap;

// The drivers that regions use.
std::set<std::string> DriversIn(const wrinkle::Rig& rig) {
  std::set<std::string> names;
  for (const wrinkle::Region& region : rig.regions) {
    names.insert(region.mask.driver);
    for (const wrinkle::Feed& feed : region.feeds) {
      for (const auto& source : feed.sources) names.insert(source.driver);
    }
  }
  return names;
}

}  // namespace

void RemoveClothMaps(wrinkle::Rig* rig) {
  std::set<std::string> maps, regions, weights;
  for (const WrinkleMap& map : rig->wrinkle_maps) {
    if (map.surface == WrinkleMap::Surface::kCloth) maps.insert(map.name);
  }
  if (maps.empty()) return;
  const std::set<std::string> before = DriversIn(*rig);
  std::erase_if(rig->wrinkle_maps, [&](const WrinkleMap& map) { return maps.contains(map.name); });
  for (WrinkleMap& map : rig->wrinkle_maps) {
    if (maps.contains(map.opposes)) map.opposes.clear();
  }
  for (wrinkle::Region& region : rig->regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      if (maps.contains(feed.map)) weights.insert(region.name + "." + feed.map);
    }
    std::erase_if(region.feeds, [&](const auto& feed) { return maps.contains(feed.map); });
    if (!region.feeds.empty()) regions.insert(region.name);
  }
  std::erase_if(rig->regions, [](const auto& region) { return region.feeds.empty(); });
  for (wrinkle::Region& region : rig->regions) {
    std::erase_if(region.neighbours, [&](const auto& name) { return !regions.contains(name); });
  }
  const std::set<std::string> after = DriversIn(*rig);
  std::erase_if(rig->drivers, [&](const wrinkle::Driver& driver) {
    return before.contains(driver.name) && !after.contains(driver.name);
  });
  std::erase_if(rig->exports, [&](const auto& e) { return weights.contains(e.weight); });
}

}  // namespace furrow::authoring
