// SPDX-License-Identifier: Apache-2.0
#include "render/settings/named_settings.h"

#include <limits>

#include <gtest/gtest.h>

#include "render/settings/settings_file.h"

namespace furrow::render {
namespace {

TEST(NamedSettings, EverySettingTakesItsOwnDefault) {
  for (const SettingInfo& info : AllSettings()) {
    Settings settings;
    const Status status = SetSetting(info.name, info.default_value, &settings);
    EXPECT_TRUE(status.ok()) << status.ToString();
    EXPECT_EQ(GetSetting(info.name, settings), info.default_value) << info.name;
    EXPECT_FALSE(info.help.empty()) << info.name;
  }
  EXPECT_TRUE(CheckSettings(Settings()).ok()) << CheckSettings(Settings()).ToString();
}

TEST(NamedSettings, SetsEachKind) {
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

// Each error lists the valid values, and the settings stay unchanged.
TEST(NamedSettings, RejectsInvalidValues) {
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
  for (const auto& [assignment, valid] : cases) {
    Settings settings;
    const Status status = SetSetting(assignment, &settings);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << assignment;
    EXPECT_NE(status.ToString().find(valid), std::string::npos) << status.ToString();
    EXPECT_EQ(SettingsToToml(settings), SettingsToToml(Settings())) << assignment;
  }
}

TEST(NamedSettings, AnUnknownNameListsSimilarNames) {
  Settings settings;
  const Status in_table = SetSetting("subsurface.metod", "off", &settings);
  EXPECT_EQ(in_table.code(), StatusCode::kNotFound);
  EXPECT_NE(in_table.todo().find("subsurface.method"), std::string::npos) << in_table.ToString();
  const Status elsewhere = SetSetting("radius_mm", "3", &settings);
  EXPECT_NE(elsewhere.todo().find("occlusion.radius_mm"), std::string::npos);
  EXPECT_EQ(SetSetting("exposure", &settings).code(), StatusCode::kInvalidArgument);
}

TEST(NamedSettings, CheckNamesTheField) {
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

}  // namespace
}  // namespace furrow::render
