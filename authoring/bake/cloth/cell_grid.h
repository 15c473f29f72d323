// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace furrow::authoring {

// Items at places in space, by the cube of a grid that they lie in. Finds those near a place.
template <class Item>
class CellGrid {
 public:
  // `cell`: the edge of a cube, metres.
  explicit CellGrid(float cell) : cell_(cell) {}

  void Add(const glm::vec3& place, const Item& item) {
    cells_[KeyOf(CellOf(place))].push_back(item);
  }
  // Visits the items of all cubes that the box from `low` to `high` touches.
  template <class Visit>
  void Within(const glm::vec3& low, const glm::vec3& high, const Visit& visit) const {
    const glm::ivec3 first = CellOf(low), last = CellOf(high);
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
          const auto found = cells_.find(KeyOf({x, y, z}));
          if (found == cells_.end()) continue;
          for (const Item& item : found->second) visit(item);
        }
      }
    }
  }

 private:
  [[nodiscard]] glm::ivec3 CellOf(const glm::vec3& place) const {
    return glm::ivec3(glm::floor(place / cell_));
  }
  static std::uint64_t KeyOf(const glm::ivec3& cell) {
    constexpr int kBias = 1 << 20;
    return (static_cast<std::uint64_t>(cell.x + kBias) << 42) ^
           (static_cast<std::uint64_t>(cell.y + kBias) << 21) ^
           static_cast<std::uint64_t>(cell.z + kBias);
  }
  float cell_;
  std::unordered_map<std::uint64_t, std::vector<Item>> cells_;
};

}  // namespace furrow::authoring
