// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/fabric.h"

#include <string_view>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

FabricFolds Of(std::string_view name) { return FoldsOf(*FindFabric(name)); }

// Worked out by hand from B, T = 10 N/m and L = 15 cm: 2 sqrt(pi) (B / T)^(1/4) sqrt(L).
TEST(Fabric, FoldsAsWideAsItsStiffnessSays) {
  EXPECT_NEAR(Of("cotton").wavelength, 0.0382f, 2e-4f);
  EXPECT_NEAR(Of("wool").wavelength, 0.0454f, 2e-4f);
  EXPECT_NEAR(Of("denim").wavelength, 0.0680f, 2e-4f);
  EXPECT_NEAR(Of("jersey").wavelength, 0.0290f, 2e-4f);
}

// The law's fourth root of the tension: (10 N/m / (weight * 9.81 m/s^2 * 0.8 m))^(1/4).
TEST(Fabric, HangsInWiderFoldsIfLight) {
  EXPECT_NEAR(Of("cotton").hanging, 1.805f, 1e-3f);
  EXPECT_NEAR(Of("wool").hanging, 1.503f, 1e-3f);
  EXPECT_NEAR(Of("denim").hanging, 1.320f, 1e-3f);
  EXPECT_NEAR(Of("jersey").hanging, 1.680f, 1e-3f);
}

// sqrt(B / 2 N/m) / (2 sin(22.5 degrees)) and half of the thickness, in millimetres: wool
// 2.449 / 0.7654 + 0.25.
TEST(Fabric, CreasesAsSharplyAsItIsThinAndLimp) {
  EXPECT_NEAR(Of("cotton").radius, 2.41e-3f, 1e-5f);
  EXPECT_NEAR(Of("wool").radius, 3.45e-3f, 1e-5f);
  EXPECT_NEAR(Of("denim").radius, 7.61e-3f, 1e-5f);
  EXPECT_NEAR(Of("jersey").radius, 1.61e-3f, 1e-5f);
}

TEST(Fabric, KnittedClothStretchesBeforeItSlips) {
  EXPECT_FLOAT_EQ(Of("jersey").stretches, 0.125f);
  for (const std::string_view woven : {"cotton", "wool", "denim"}) {
    EXPECT_LT(Of(woven).stretches, 0.01f) << woven;
  }
}

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
