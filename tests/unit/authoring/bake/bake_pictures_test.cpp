// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_pictures.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/bake/layers/blood.h"

namespace furrow::authoring {
namespace {

BakedMap Square(int side) {
  BakedMap map;
  map.map = "squash";
  map.width = map.height = side;
  const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  map.height_mm.assign(count, 0.5f);
  map.derivative.assign(2 * count, 0.0f);
  map.cavity.assign(count, 1.0f);
  map.blood.assign(count, 1.0f);
  return map;
}

float ToLinear(std::uint8_t srgb) {
  return std::pow((static_cast<float>(srgb) / 255.0f + 0.055f) / 1.055f, 2.4f);
}

std::vector<std::string> Names(const std::vector<character::Picture>& pictures) {
  std::vector<std::string> names;
  for (const character::Picture& picture : pictures) names.push_back(picture.name);
  return names;
}

TEST(NormalPicture, ContainsTheNormalOfTheDerivative) {
  BakedMap map;
  map.width = 2;
  map.height = 1;
  map.derivative = {0.0f, 0.0f, 1.0f, -1.0f};
  const character::Picture picture = NormalPicture(map, "n");
  ASSERT_EQ(picture.pixels16.size(), 6u);
  EXPECT_EQ(picture.pixels16[0], 32768);
  EXPECT_EQ(picture.pixels16[2], 65535);
  const auto value = [&](int i) { return picture.pixels16[3 + i] / 65535.0f * 2.0f - 1.0f; };
  EXPECT_NEAR(value(0) / value(2), 1.0f, 1e-3f);
  EXPECT_NEAR(value(1) / value(2), -1.0f, 1e-3f);
}

TEST(ColourPicture, LeavesSkinAtRestUnchanged) {
  BakedMap map = Square(1);
  map.width = 3;
  map.blood = {1.0f, 1.5f, 0.6f};
  const character::Picture picture = ColourPicture(map, kBloodTintScale, "c");
  ASSERT_EQ(picture.pixels.size(), 9u);
  const auto factor = [&](int i) { return ToLinear(picture.pixels[i]) * kBloodTintScale; };
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(factor(c), 1.0f, 1e-6f);
    EXPECT_NEAR(factor(3 + c), BloodTint(1.5f)[c], 0.006f);
    EXPECT_NEAR(factor(6 + c), BloodTint(0.6f)[c], 0.006f);
  }
}

TEST(Halved, AveragesFourTexels) {
  BakedMap map = Square(4);
  for (std::size_t i = 0; i < 16; ++i) {
    map.height_mm[i] = static_cast<float>(i);
    map.derivative[2 * i + 1] = static_cast<float>(i);
  }
  const BakedMap half = Halved(map);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 2);
  EXPECT_EQ(half.height_mm, (std::vector<float>{2.5f, 4.5f, 10.5f, 12.5f}));
  EXPECT_EQ(half.derivative,
            (std::vector<float>{0.0f, 2.5f, 0.0f, 4.5f, 0.0f, 10.5f, 0.0f, 12.5f}));
  EXPECT_EQ(half.cavity.size(), 4u);
  EXPECT_EQ(half.blood.size(), 4u);
}

TEST(WrinkleMapPictures, MakesThePicturesThatTheRigNames) {
  const BakedMap map = Square(64);
  wrinkle::WrinkleMap named{.name = "squash", .normal = "n", .height = "h", .height_mm = 2.0f};
  auto some = WrinkleMapPictures(map, named);
  ASSERT_TRUE(some.ok());
  EXPECT_EQ(Names(*some), (std::vector<std::string>{"n", "h"}));
  EXPECT_EQ((*some)[1].pixels16[0], 40959);  // 0.25 in a signed texel
  named.colour = "c";
  named.cavity = "v";
  const auto all = WrinkleMapPictures(map, named);
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(Names(*all), (std::vector<std::string>{"n", "h", "v", "c"}));
  for (const character::Picture& picture : *all) EXPECT_EQ(picture.width, 64) << picture.name;
}

TEST(WrinkleMapPictures, HalvesLargePicturesExceptNormals) {
  const wrinkle::WrinkleMap named{
      .name = "squash", .normal = "n", .height = "h", .colour = "c", .cavity = "v"};
  const auto pictures = WrinkleMapPictures(Square(2 * kSmallestHalf), named);
  ASSERT_TRUE(pictures.ok());
  for (const character::Picture& picture : *pictures) {
    EXPECT_EQ(picture.width, picture.name == "n" ? 2 * kSmallestHalf : kSmallestHalf);
  }
  const auto odd = WrinkleMapPictures(Square(2 * kSmallestHalf + 1), named);
  ASSERT_TRUE(odd.ok());
  for (const character::Picture& picture : *odd) EXPECT_EQ(picture.width, 2 * kSmallestHalf + 1);
}

TEST(WrinkleMapPictures, RejectsFoldsBeyondTheRangeOfTheRig) {
  const wrinkle::WrinkleMap named{.name = "squash", .height = "h", .height_mm = 0.4f};
  const Status status = WrinkleMapPictures(Square(8), named).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.what().find("0.50 mm high"), std::string::npos) << status.ToString();
}

}  // namespace
}  // namespace furrow::authoring
