// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_combinations.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "rig/shapes/arkit_shapes.h"

namespace furrow::authoring {
namespace {

TEST(ShapeCombinations, NameOnlyShapesOfArkit) {
  std::set<std::string> known;
  for (const std::string_view name : rig::ArkitShapes()) known.insert(std::string(name));
  for (const ShapeCombination& combination : ShapeCombinations()) {
    bool leads = false;
    for (const ShapeCombination::Part& part : combination.parts) {
      leads = leads || std::string(part.shape) == combination.lead;
      EXPECT_GT(part.weight, 0.0f);
      EXPECT_LE(part.weight, 1.0f);
      for (const std::string& name : ShapesOf(part.shape)) {
        EXPECT_TRUE(known.contains(name)) << name;
      }
    }
    EXPECT_TRUE(leads) << combination.lead;
  }
}

}  // namespace
}  // namespace furrow::authoring
