// SPDX-License-Identifier: Apache-2.0
#include "rig/exports/export_profile.h"

#include <filesystem>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace fs = std::filesystem;

constexpr char kValid[] = R"({
  // comments are allowed
  "version": 1, "name": "other", "title": "Another system", "sides": {"left": "L", "right": "R"},
  "names": {"down_*": "brow_*.squash", "nose": ["nose.squash", "glabella.squash"], "jaw": []}})";

wrinkle::Rig SmallRig() {
  wrinkle::Rig rig;
  for (const char* region : {"brow_l", "brow_r", "nose"}) {
    rig.regions.push_back(
        {.name = region, .mask = {}, .feeds = {{.map = "squash", .sources = {}}}});
  }
  return rig;
}

TEST(ExportProfile, ExpandsSidesAndKeepsTheOrder) {
  const auto profile = ParseExportProfile(kValid, "other.json");
  ASSERT_TRUE(profile.ok()) << profile.status().ToString();
  EXPECT_EQ(profile->name, "other");
  EXPECT_EQ(profile->title, "Another system");
  ASSERT_EQ(profile->names.size(), 4u);
  EXPECT_EQ(profile->names[0].name, "down_L");
  EXPECT_THAT(profile->names[0].weights, ElementsAre("brow_l.squash"));
  EXPECT_EQ(profile->names[1].name, "down_R");
  EXPECT_THAT(profile->names[1].weights, ElementsAre("brow_r.squash"));
  EXPECT_THAT(profile->names[2].weights, ElementsAre("nose.squash", "glabella.squash"));
  EXPECT_THAT(profile->names[3].weights, IsEmpty());
}

TEST(ExportProfile, RefusesEachMalformedFieldByName) {
  const struct {
    const char* text;
    StatusCode code;
    const char* where;
  } cases[] = {
      {"[]", StatusCode::kSchema, "(root)"},
      {R"({"version": 1, "name": "a"})", StatusCode::kSchema, "names"},
      {R"({"version": 2, "name": "a", "names": {"b": []}})", StatusCode::kUnsupported, "version"},
      {R"({"version": 1, "name": "", "names": {"b": []}})", StatusCode::kSchema, "name"},
      {R"({"version": 1, "name": "a", "names": {}})", StatusCode::kSchema, "names"},
      {R"({"version": 1, "name": "a", "names": {"b": 3}})", StatusCode::kSchema, "names.'b'"},
      {R"({"version": 1, "name": "a", "names": {"b": [3]}})", StatusCode::kSchema, "names.'b'"},
      {R"({"version": 1, "name": "a", "names": {"b\u001b": []}})", StatusCode::kSchema,
       "names.'b?'"},
      {R"({"version": 1, "name": "a\u0007", "names": {"b": []}})", StatusCode::kSchema, "name"},
      {R"({"version": 1, "name": "a", "names": {"b_*": []}})", StatusCode::kSchema, "names.'b_*'"},
      {R"({"version": 1, "name": "a", "names": {"b": "x_*.y"}})", StatusCode::kSchema, "names.'b'"},
      {R"({"version": 1, "name": "a", "name2": 1, "names": {"b": []}})", StatusCode::kSchema,
       "'name2'"},
      {R"({"version": 1, "name": "a", "sides": {"left": "x", "right": "x"}, "names": {"b": []}})",
       StatusCode::kSchema, "sides"},
      {R"({"version": 1, "name": "a", "sides": {"left": "L", "right": "R"},
           "names": {"b_*": [], "b_L": []}})",
       StatusCode::kSchema, "names.'b_L'"},
  };
  for (const auto& c : cases) {
    const auto profile = ParseExportProfile(c.text, "p.json");
    ASSERT_FALSE(profile.ok()) << c.text;
    EXPECT_EQ(profile.status().code(), c.code) << c.text;
    EXPECT_EQ(profile.status().where(), std::string("p.json: ") + c.where) << c.text;
  }
}

TEST(ExportProfile, RefusesEveryTruncationAndExtraBytes) {
  const std::string text = kValid;
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_FALSE(ParseExportProfile(text.substr(0, length), "p.json").ok()) << length;
  }
  EXPECT_EQ(ParseExportProfile(text + "}", "p.json").status().code(), StatusCode::kParse);
}

TEST(ExportProfile, RefusesTooManyNamesAndWeights) {
  std::string names;
  for (int i = 0; i <= 4096; ++i)
    names += (i > 0 ? "," : "") + ("\"n" + std::to_string(i)) + "\":[]";
  const std::string head = R"({"version":1,"name":"a","names":{)";
  EXPECT_EQ(ParseExportProfile(head + names + "}}", "p").status().code(), StatusCode::kLimit);
  std::string weights = "\"w\"";
  for (int i = 0; i < 16; ++i) weights += ",\"w\"";
  EXPECT_EQ(ParseExportProfile(head + "\"n\":[" + weights + "]}}", "p").status().code(),
            StatusCode::kLimit);
  EXPECT_EQ(ParseExportProfile(std::string((1 << 20) + 1, ' '), "p").status().code(),
            StatusCode::kLimit);
}

TEST(ExportProfile, CoversWithTheWeightsThatTheRigHas) {
  const auto profile = ParseExportProfile(kValid, "other.json");
  ASSERT_TRUE(profile.ok());
  wrinkle::Rig rig = SmallRig();
  rig.regions.push_back({.name = "chin", .mask = {}, .feeds = {{.map = "folds", .sources = {}}}});
  const ExportCoverage coverage = CoverExports(rig, *profile);
  EXPECT_EQ(coverage.covered(), 3u);
  EXPECT_THAT(coverage.names[2].weights, ElementsAre("nose.squash"));  // without the glabella
  EXPECT_THAT(coverage.unnamed, ElementsAre("chin.folds"));
  const std::string text = ToText(coverage);
  EXPECT_THAT(text, HasSubstr("3 of 4 names covered"));
  EXPECT_THAT(text, HasSubstr("  down_L <- brow_l.squash\n"));
  EXPECT_THAT(text, HasSubstr("names without a weight:\n  jaw\n"));
  EXPECT_THAT(text, HasSubstr("weights without a name:\n  chin.folds\n"));
}

// The parser's work grows with the square of the number of fields.
TEST(ExportProfile, LimitsTheNumberOfFields) {
  const auto with_names = [](std::size_t count) {
    std::string text = R"({"version": 1, "name": "other", "names": {"n0": "a")";
    for (std::size_t i = 1; i < count; ++i) text += ",\"n" + std::to_string(i) + "\":\"a\"";
    return text + "}}";
  };
  EXPECT_TRUE(ParseExportProfile(with_names(4096), "other.json").ok());
  const auto many = ParseExportProfile(with_names(80'000), "other.json");
  ASSERT_FALSE(many.ok());
  EXPECT_EQ(many.status().code(), StatusCode::kLimit);
  EXPECT_THAT(many.status().ToString(), HasSubstr("other.json: has more than 8192 fields"));
}

TEST(ExportProfile, TheRigsOwnExportsComeFirst) {
  const auto profile = ParseExportProfile(kValid, "other.json");
  ASSERT_TRUE(profile.ok());
  wrinkle::Rig rig = SmallRig();
  rig.exports = {{"other", "brow_r.squash", "jaw"},
                 {"other", "nose.squash", "own"},
                 {"another", "nose.squash", "unrelated"}};
  const ExportCoverage coverage = CoverExports(rig, *profile);
  ASSERT_EQ(coverage.names.size(), 5u);
  EXPECT_THAT(coverage.names[3].weights, ElementsAre("brow_r.squash"));
  EXPECT_EQ(coverage.names[4].name, "own");
}

TEST(ExportProfile, ShippedProfilesAreValidAndCoverTheFace) {
  const fs::path root = fs::path(FURROW_SOURCE_DIR) / "rig";
  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(root / "export_profiles")) {
    const auto text = ReadFile(file.path(), 1 << 20);
    ASSERT_TRUE(text.ok());
    const auto profile = ParseExportProfile(*text, file.path().string());
    ASSERT_TRUE(profile.ok()) << profile.status().ToString();
    EXPECT_EQ(profile->name, file.path().stem().string());
    names.insert(profile->name);
    // Every weight that a profile names exists in the rig with the eight regions of a face.
    const auto rig = LoadRig(root / "rigs" / "arkit.json");
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    wrinkle::Rig without_exports = *rig;
    without_exports.exports.clear();
    const ExportCoverage coverage = CoverExports(without_exports, *profile);
    for (std::size_t i = 0; i < profile->names.size(); ++i) {
      EXPECT_EQ(coverage.names[i].weights, profile->names[i].weights) << profile->names[i].name;
    }
  }
  EXPECT_THAT(names, ElementsAre("arkit", "character_creator", "metahuman"));
}

}  // namespace
}  // namespace furrow::rig
