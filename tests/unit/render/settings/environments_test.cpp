// SPDX-License-Identifier: Apache-2.0
// The settings files of render/environments.
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "render/settings/settings_file.h"

namespace furrow::render {
namespace {

std::vector<std::filesystem::path> Environments() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(FURROW_SOURCE_DIR "/render/environments")) {
    files.push_back(entry.path());
  }
  return files;
}

TEST(Environments, ChangeLightsAndExposureOnly) {
  EXPECT_GE(Environments().size(), 5u);
  for (const auto& file : Environments()) {
    Settings settings;
    const Status status = LoadSettings(file, &settings);
    ASSERT_TRUE(status.ok()) << status.ToString();
    settings.lights = {};
    settings.exposure = Settings().exposure;
    EXPECT_EQ(settings, Settings()) << file;
  }
}

// A page or a script that chooses one after the other then keeps nothing of the first.
TEST(Environments, NameAllTheirSettings) {
  for (const auto& file : Environments()) {
    Settings from_defaults;
    Settings from_others;
    from_others.exposure = 7.0f;
    from_others.lights = {
        LightPreset::kHard, 3.0f,           3.0f, 33.0f, 33.0f, glm::vec3(0.3f), glm::vec3(0.3f),
        glm::vec3(0.3f),    glm::vec3(0.3f)};
    ASSERT_TRUE(LoadSettings(file, &from_defaults).ok());
    ASSERT_TRUE(LoadSettings(file, &from_others).ok());
    EXPECT_EQ(from_others, from_defaults) << file;
  }
}

}  // namespace
}  // namespace furrow::render
