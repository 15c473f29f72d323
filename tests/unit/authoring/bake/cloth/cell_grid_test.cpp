// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/cell_grid.h"

#include <algorithm>
#include <vector>

#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TEST(CellGrid, FindsWhatABoxHoldsOnBothSidesOfTheOrigin) {
  CellGrid<int> grid(0.1f);
  std::vector<glm::vec3> places;
  for (int i = 0; i < 343; ++i) {
    places.push_back(0.07f * glm::vec3(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3));
    grid.Add(places.back(), i);
  }
  const glm::vec3 low(-0.15f, -0.02f, 0.03f), high(0.05f, 0.2f, 0.16f);
  std::vector<int> found;
  grid.Within(low, high, [&](int item) { found.push_back(item); });
  for (int i = 0; i < 343; ++i) {
    const bool inside = glm::all(glm::lessThanEqual(low, places[static_cast<std::size_t>(i)])) &&
                        glm::all(glm::lessThanEqual(places[static_cast<std::size_t>(i)], high));
    const auto count = std::count(found.begin(), found.end(), i);
    EXPECT_LE(count, 1) << i;
    if (inside) EXPECT_EQ(count, 1) << i;
  }
  EXPECT_LT(found.size(), 343u) << "cubes far away are left out";
}

}  // namespace
}  // namespace furrow::authoring
