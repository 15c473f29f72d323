// SPDX-License-Identifier: Apache-2.0
#include "render/settings/settings.h"

#include <limits>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

TEST(Settings, EverySettingTakesItsOwnDefault) {
  for (const SettingInfo& info : AllSettings()) {
    Settings settings;
    const Status status = SetSetting(info.name, info.default_value, &settings);
    EXPECT_TRUE(status.ok()) << status.ToString();
    EXPECT_EQ(GetSetting(info.name, settings), info.default_value) << info.name;
    EXPECT_FALSE(info.help.empty()) << info.name;
  }
  EXPECT_TRUE(CheckSettings(Settings()).ok()) << CheckSettings(Settings()).ToString();
}

TEST(Settings, AreSetByName) {
  Settings settings;
  ASSERT_TRUE(SetSetting("subsurface.method=burley", &settings).ok());
  ASSERT_TRUE(SetSetting("subsurface.taps=25", &settings).ok());
  ASSERT_TRUE(SetSetting("background", "0, 0.5,1", &settings).ok());
  ASSERT_TRUE(SetSetting("translucency.enabled", "off", &settings).ok());
  ASSERT_TRUE(SetSetting("strip.views", "depth,normal", &settings).ok());
  EXPECT_EQ(settings.subsurface.method, SubsurfaceMethod::kBurley);
  EXPECT_EQ(settings.subsurface.taps, 25);
  EXPECT_EQ(settings.background, glm::vec3(0.0f, 0.5f, 1.0f));
  EXPECT_FALSE(settings.translucency.enabled);
  EXPECT_EQ(settings.strip.views, (std::vector{View::kDepth, View::kNormal}));
}

// Each is refused with what is allowed, and nothing changes.
TEST(Settings, RefuseWhatIsNotAllowed) {
  const std::pair<const char*, const char*> cases[] = {
      {"subsurface.method=jimenez", "separable"},
      {"subsurface.taps=12", "11, 17, 25"},
      {"exposure=0", "(0, 16]"},
      {"exposure=nan", "(0, 16]"},
      {"exposure=1x", "(0, 16]"},
      {"shadow.resolution=64", "[128, 4096]"},
      {"wrinkles=maybe", "on, off"},
      {"background=1,1", "three numbers"},
      {"background=1,1,2", "[0, 1]"},
      {"strip.views=depth,dept", "mask_dynamic"},
  };
  for (const auto& [assignment, allowed] : cases) {
    Settings settings;
    const Status status = SetSetting(assignment, &settings);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << assignment;
    EXPECT_NE(status.ToString().find(allowed), std::string::npos) << status.ToString();
    EXPECT_EQ(SettingsToToml(settings), SettingsToToml(Settings())) << assignment;
  }
}

TEST(Settings, AnUnknownNameListsItsNeighbours) {
  Settings settings;
  const Status in_table = SetSetting("subsurface.metod", "off", &settings);
  EXPECT_EQ(in_table.code(), StatusCode::kNotFound);
  EXPECT_NE(in_table.todo().find("subsurface.method"), std::string::npos) << in_table.ToString();
  const Status elsewhere = SetSetting("radius_mm", "3", &settings);
  EXPECT_NE(elsewhere.todo().find("occlusion.radius_mm"), std::string::npos);
  EXPECT_EQ(SetSetting("exposure", &settings).code(), StatusCode::kInvalidArgument);
}

TEST(Settings, CheckNamesTheField) {
  Settings settings;
  settings.subsurface.taps = 12;
  EXPECT_EQ(CheckSettings(settings).where(), "settings.subsurface.taps");
  settings = {};
  settings.bloom.radius = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(CheckSettings(settings).where(), "settings.bloom.radius");
  settings = {};
  settings.view = static_cast<View>(kNumViews);
  EXPECT_EQ(CheckSettings(settings).where(), "settings.view");
  settings = {};
  settings.strip.views.resize(7);
  EXPECT_EQ(CheckSettings(settings).where(), "settings.strip.views");
}

TEST(Settings, TomlSaysAllAndIsReadBack) {
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

TEST(Settings, TomlKeepsWhatItDoesNotSay) {
  Settings settings;
  settings.exposure = 2.0f;
  ASSERT_TRUE(ParseSettings("shading = 'skin'\n[occlusion]\nradius_mm = 40", "t", &settings).ok());
  EXPECT_EQ(settings.exposure, 2.0f);
  EXPECT_EQ(settings.shading, Shading::kSkin);
  EXPECT_EQ(settings.occlusion.radius_mm, 40.0f);
}

TEST(Settings, TomlErrorsNameLineAndSetting) {
  const auto refuse = [](const char* toml, StatusCode code, const char* where, const char* word) {
    Settings settings;
    const Status status = ParseSettings(toml, "look.toml", &settings);
    EXPECT_EQ(status.code(), code) << toml;
    EXPECT_EQ(status.where(), where) << status.ToString();
    EXPECT_NE(status.ToString().find(word), std::string::npos) << status.ToString();
    EXPECT_EQ(SettingsToToml(settings), SettingsToToml(Settings()));  // all or nothing
  };
  refuse("exposure = 1.5\n[subsurface]\ntaps = 12", StatusCode::kInvalidArgument, "look.toml:3",
         "11, 17, 25");
  refuse("[subsurface]\ntap = 11", StatusCode::kSchema, "look.toml:2", "subsurface.taps");
  refuse("[subsurface]\ntaps = '11'", StatusCode::kSchema, "look.toml:2", "a whole number");
  refuse("wrinkles = 1", StatusCode::kSchema, "look.toml:1", "true or false");
  refuse("background = [1, 'a', 0]", StatusCode::kSchema, "look.toml:1", "three numbers");
  refuse("exposure = ", StatusCode::kParse, "look.toml:1", "");
  Settings settings;
  EXPECT_EQ(LoadSettings("/no/such/look.toml", &settings).code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::render
