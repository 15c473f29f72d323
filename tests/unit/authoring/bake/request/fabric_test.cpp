// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/fabric.h"

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// Worked out by hand from B, T = 10 N/m and L = 15 cm: 2 sqrt(pi) (B / T)^(1/4) sqrt(L).
TEST(Fabric, FoldsAsWideAsItsStiffnessSays) {
  EXPECT_NEAR(FoldWavelength(*FindFabric("cotton")), 0.0382f, 2e-4f);
  EXPECT_NEAR(FoldWavelength(*FindFabric("wool")), 0.0454f, 2e-4f);
  EXPECT_NEAR(FoldWavelength(*FindFabric("denim")), 0.0680f, 2e-4f);
  EXPECT_NEAR(FoldWavelength(*FindFabric("jersey")), 0.0290f, 2e-4f);
}

// The law's fourth root of the tension: 5^(1/4) = 1.495.
TEST(Fabric, HangsInWiderFolds) { EXPECT_NEAR(HangingWidth(), 1.495f, 1e-3f); }

TEST(Fabric, IsFoundByName) {
  for (const Fabric& fabric : kFabrics) {
    EXPECT_EQ(FindFabric(fabric.name)->bending, fabric.bending);
    EXPECT_NE(FabricNames().find(fabric.name), std::string::npos);
  }
  EXPECT_FALSE(FindFabric("silk"));
  EXPECT_FALSE(FindFabric(""));
}

}  // namespace
}  // namespace furrow::authoring
