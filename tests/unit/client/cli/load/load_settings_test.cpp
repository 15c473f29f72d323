// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_settings.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::cli {
namespace {

nlohmann::json SettingsOf(const std::string& options) {
  CLI::App app;
  LoadFlags flags;
  AddLoadFlags(app, flags);
  app.parse("localhost:7401 performance.bvh " + options);
  return cli::SettingsOf(flags);
}

TEST(LoadSettings, UnsetValuesAreNull) {
  const nlohmann::json settings = SettingsOf("");
  EXPECT_EQ(settings["host"], "localhost:7401");
  EXPECT_EQ(settings["file"], "performance.bvh");
  EXPECT_EQ(settings["path"], "udp");
  EXPECT_EQ(settings["packing"], "to fit");
  for (const char* key : {"rig", "skeleton_map", "rate"})
    EXPECT_TRUE(settings[key].is_null()) << key;
  EXPECT_TRUE(settings["chaos"]["up"].is_null());
  EXPECT_FALSE(settings.contains("comparison"));
}

TEST(LoadSettings, ContainAllSettingsOfTheFigures) {
  const nlohmann::json settings = SettingsOf(
      "--rate 25 --subscribers 3 --stalled 2 --churn 1 --late 5 --seed 9 --loss 0.5 --way down "
      "--black-hole 1:2:4 --rig face.json");
  EXPECT_EQ(settings["rate"], 25.0);
  EXPECT_EQ(settings["subscribers"], 3);
  EXPECT_EQ(settings["stalled"], 2);
  EXPECT_EQ(settings["churn"], 1);
  EXPECT_EQ(settings["late_ms"], 5.0);
  EXPECT_EQ(settings["rig"], "face.json");
  EXPECT_TRUE(settings["chaos"]["up"].is_null());
  EXPECT_EQ(settings["chaos"]["down"]["seed"], 9);
  EXPECT_EQ(settings["chaos"]["down"]["loss"], 0.5);
  EXPECT_EQ(settings["chaos"]["down"]["black_holes"][0]["every"], 4.0);
}

TEST(LoadSettings, ContainNoToken) {
  CLI::App app;
  LoadFlags flags;
  AddLoadFlags(app, flags);
  app.parse("furrow://localhost:7400?token=furrow1-secret performance.bvh --tls --clock-step 3");
  const nlohmann::json settings = cli::SettingsOf(flags);
  EXPECT_EQ(settings["host"], "furrow://localhost:7400");
  EXPECT_EQ(settings["tls"], true);
  EXPECT_EQ(settings["clock_step_seconds"], 3.0);
}

TEST(LoadSettings, PosesArePackedToFitDatagramsOnlyOverUdp) {
  EXPECT_EQ(SettingsOf("--both")["packing"], "to fit");
  EXPECT_EQ(SettingsOf("--tcp")["packing"], "never");
  EXPECT_EQ(SettingsOf("--tcp --quantise")["packing"], "always");
  EXPECT_EQ(SettingsOf("--floats")["packing"], "never");
}

TEST(LoadSettings, ContainTheSettingsOfComparisons) {
  const nlohmann::json settings = SettingsOf("--baseline --rounds 5 --round-time 0.5");
  EXPECT_EQ(settings["comparison"]["baseline"], true);
  EXPECT_EQ(settings["comparison"]["find_max"], false);
  EXPECT_EQ(settings["comparison"]["rounds"], 5);
  EXPECT_EQ(settings["comparison"]["round_seconds"], 0.5);
}

}  // namespace
}  // namespace furrow::cli
