// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/weight_table.h"

#include <algorithm>
#include <utility>

#include "base/status.h"

namespace furrow::wrinkle {
namespace {

bool Lists(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// A rig without maps only computes weights and accepts any map name.
Status CheckMapName(const Rig& rig, const std::string& owner, const std::string& map) {
  const bool known =
      rig.wrinkle_maps.empty() ||
      std::any_of(rig.wrinkle_maps.begin(), rig.wrinkle_maps.end(),
                  [&](const WrinkleMap& candidate) { return candidate.name == map; });
  if (known) return {};
  return {StatusCode::kNotFound,
          owner + " names wrinkle map '" + map + "', which the rig does not have"};
}

Status CheckNeighbours(const Rig& rig, const Region& region) {
  for (const std::string& neighbour : region.neighbours) {
    const bool known = std::any_of(rig.regions.begin(), rig.regions.end(),
                                   [&](const Region& other) { return other.name == neighbour; });
    if (!known || neighbour == region.name) {
      return {known ? StatusCode::kInvalidArgument : StatusCode::kNotFound,
              "region '" + region.name + "': neighbours names '" + neighbour + "', which is " +
                  (known ? "the region itself" : "no region of the rig")};
    }
  }
  return {};
}

// The maps that must not meet `map` at a border. Either map of a pair may state it.
std::vector<std::string> OpposedMaps(const Rig& rig, const std::string& map) {
  std::vector<std::string> opposed;
  for (const WrinkleMap& candidate : rig.wrinkle_maps) {
    if (candidate.name == map && !candidate.opposes.empty()) opposed.push_back(candidate.opposes);
    if (candidate.opposes == map) opposed.push_back(candidate.name);
  }
  return opposed;
}

// Either region may name the other.
bool Adjacent(const Region& a, const Region& b) {
  return Lists(a.neighbours, b.name) || Lists(b.neighbours, a.name);
}

}  // namespace

Status WeightTable::Bind(const Rig& rig, const std::unordered_map<std::string, int>& value_index) {
  for (const WrinkleMap& map : rig.wrinkle_maps) {
    if (map.opposes.empty()) continue;
    const std::string owner = "wrinkle map '" + map.name + "': opposes";
    FURROW_RETURN_IF_ERROR(CheckMapName(rig, owner, map.opposes));
  }
  for (const Region& region : rig.regions) {
    FURROW_RETURN_IF_ERROR(CheckNeighbours(rig, region));
    for (const Feed& feed : region.feeds) {
      const std::string owner = "region '" + region.name + "': a feed";
      FURROW_RETURN_IF_ERROR(CheckMapName(rig, owner, feed.map));
      FURROW_RETURN_IF_ERROR(BindFeed(rig, region, feed, value_index));
    }
  }
  BindOpponents(rig);
  for (const Export& entry : rig.exports) {
    if (Lists(names_, entry.weight)) continue;
    return {StatusCode::kNotFound, "export '" + entry.profile + "' names wrinkle weight '" +
                                       entry.weight + "', which the rig does not have"};
  }
  return {};
}

Status WeightTable::BindFeed(const Rig& rig, const Region& region, const Feed& feed,
                             const std::unordered_map<std::string, int>& value_index) {
  Entry entry;
  entry.first_source = static_cast<std::uint32_t>(sources_.size());
  entry.num_sources = static_cast<std::uint32_t>(feed.sources.size());
  entry.combine = region.combine;
  FeedModulation modulation = ModulationOf(rig, region, feed);
  entry.modulation = modulation.modulation;
  entry.curve = std::move(modulation.curve);
  for (const Feed::Source& source : feed.sources) {
    const auto found = value_index.find(source.driver + "." + source.value);
    if (found == value_index.end()) {
      return {StatusCode::kNotFound, "region '" + region.name + "': feed '" + feed.map +
                                         "' names driver value '" + source.driver + "." +
                                         source.value + "', which the rig does not have"};
    }
    sources_.push_back({.driver_value = found->second, .gain = source.gain});
  }
  entries_.push_back(std::move(entry));
  names_.push_back(region.name + "." + feed.map);
  return {};
}

void WeightTable::BindOpponents(const Rig& rig) {
  // Weights are numbered region by region and feed by feed, in the order in which Bind() added
  // them.
  std::size_t weight = 0;
  for (const Region& own : rig.regions) {
    std::vector<std::pair<const Feed*, std::uint16_t>> neighbours;  // their feeds and weights
    std::uint16_t first = 0;
    for (const Region& other : rig.regions) {
      const std::size_t count = Adjacent(own, other) ? other.feeds.size() : 0;
      for (std::size_t i = 0; i < count; ++i) {
        neighbours.emplace_back(&other.feeds[i], static_cast<std::uint16_t>(first + i));
      }
      first = static_cast<std::uint16_t>(first + other.feeds.size());
    }
    for (const Feed& feed : own.feeds) {
      Entry& entry = entries_[weight++];
      entry.first_opponent = static_cast<std::uint32_t>(opponents_.size());
      const std::vector<std::string> opposed = OpposedMaps(rig, feed.map);
      for (const auto& [other, index] : neighbours) {
        if (Lists(opposed, other->map)) opponents_.push_back(index);
      }
      entry.num_opponents = static_cast<std::uint32_t>(opponents_.size()) - entry.first_opponent;
    }
  }
}

}  // namespace furrow::wrinkle
