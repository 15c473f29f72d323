// SPDX-License-Identifier: Apache-2.0
#include "render/settings/settings_file.h"

#include <gtest/gtest.h>

#include "render/settings/named_settings.h"

namespace furrow::render {
namespace {

TEST(SettingsFile, HoldsAllSettingsAndReadsBackEqual) {
  Settings settings;
  settings.view = View::kOcclusion;
  settings.shadow.softness_mm = 1.25f;
  settings.background = {0.1f, 0.2f, 0.3f};
  settings.specular.widen = false;
  settings.strip.views = {View::kShadow, View::kBloom};
  const std::string toml = SettingsToToml(settings);
  for (const SettingInfo& info : AllSettings()) {
    EXPECT_NE(toml.find(info.help), std::string::npos) << info.name;
  }
  Settings read;
  const Status status = ParseSettings(toml, "all.toml", &read);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(SettingsToToml(read), toml);
}

TEST(SettingsFile, KeepsSettingsThatTheFileDoesNotMention) {
  Settings settings;
  settings.exposure = 2.0f;
  ASSERT_TRUE(ParseSettings("shading = 'skin'\n[occlusion]\nradius_mm = 40", "t", &settings).ok());
  EXPECT_EQ(settings.exposure, 2.0f);
  EXPECT_EQ(settings.shading, Shading::kSkin);
  EXPECT_EQ(settings.occlusion.radius_mm, 40.0f);
}

TEST(SettingsFile, ErrorsNameLineAndSetting) {
  const auto expect_error = [](const char* toml, StatusCode code, const char* where,
                               const char* word) {
    Settings settings;
    const Status status = ParseSettings(toml, "look.toml", &settings);
    EXPECT_EQ(status.code(), code) << toml;
    EXPECT_EQ(status.where(), where) << status.ToString();
    EXPECT_NE(status.ToString().find(word), std::string::npos) << status.ToString();
    EXPECT_EQ(SettingsToToml(settings), SettingsToToml(Settings()));  // unchanged
  };
  expect_error("exposure = 1.5\n[subsurface]\ntaps = 12", StatusCode::kInvalidArgument,
               "look.toml:3", "11, 17, 25");
  expect_error("[subsurface]\ntap = 11", StatusCode::kSchema, "look.toml:2", "subsurface.taps");
  expect_error("[subsurface]\ntaps = '11'", StatusCode::kSchema, "look.toml:2", "a whole number");
  expect_error("wrinkles = 1", StatusCode::kSchema, "look.toml:1", "true or false");
  expect_error("background = [1, 'a', 0]", StatusCode::kSchema, "look.toml:1", "three numbers");
  expect_error("exposure = ", StatusCode::kParse, "look.toml:1", "");
  Settings settings;
  EXPECT_EQ(LoadSettings("/no/such/look.toml", &settings).code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::render
