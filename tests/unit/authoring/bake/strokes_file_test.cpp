// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/strokes_file.h"

#include <string>

#include <gtest/gtest.h>

#include "base/files.h"

namespace furrow::authoring {
namespace {

wrinkle::Rig SmallRig() {
  wrinkle::Rig rig;
  rig.wrinkle_maps = {{.name = "stretch"}, {.name = "squash"}};
  for (const char* name : {"brow_l", "brow_r", "glabella"}) rig.regions.emplace_back().name = name;
  return rig;
}

// One field per line.
constexpr char kStrokes[] = R"({
  "strokes": [
    // frontalis
    {"name": "furrow_1_l",
     "muscle": "frontalis",
     "maps": ["stretch"],
     "region": "brow_l",
     "points": [[0.01, 1.7, 0.1],
                [0.03, 1.71, 0.09]],
     "mirror": true,
     "width_mm": 3,
     "taper": 0.5},
    {"name": "glabella", "kind": "direction", "maps": ["squash", "stretch"], "wavelength_mm": 4,
     "smooth": false, "personal": true, "points": [[0, 1.69, 0.1], [0, 1.72, 0.1], {"x": 0, "y": 1.73, "z": 0.1}]}
  ]
}
)";

Result<std::vector<BakeStroke>> Parse(std::string_view json) {
  return ParseStrokes(json, "a.json", SmallRig());
}

TEST(StrokesFile, ReadsEveryField) {
  const auto strokes = Parse(kStrokes);
  ASSERT_TRUE(strokes.ok()) << strokes.status().ToString();
  ASSERT_EQ(strokes->size(), 3u);
  const BakeStroke& furrow = (*strokes)[0];
  EXPECT_EQ(furrow.kind, BakeStroke::Kind::kFold);
  EXPECT_EQ(furrow.muscle, "frontalis");
  EXPECT_EQ(furrow.maps, std::vector<std::string>{"stretch"});
  EXPECT_EQ(furrow.points[1], glm::vec3(0.03f, 1.71f, 0.09f));
  EXPECT_TRUE(furrow.smooth);
  EXPECT_EQ(furrow.width_mm, 3.0f);
  EXPECT_EQ(furrow.depth_mm, 0.5f);
  EXPECT_EQ(furrow.taper, 0.5f);
  const BakeStroke& direction = (*strokes)[2];
  EXPECT_EQ(direction.kind, BakeStroke::Kind::kDirection);
  EXPECT_FALSE(direction.smooth);
  EXPECT_TRUE(direction.personal);
  EXPECT_FALSE(furrow.personal);
  EXPECT_EQ(direction.points.size(), 3u);
  EXPECT_EQ(direction.wavelength_mm, 4.0f);
}

TEST(StrokesFile, MirrorsToTheOtherSide) {
  const auto strokes = Parse(kStrokes);
  ASSERT_TRUE(strokes.ok());
  const BakeStroke& mirrored = (*strokes)[1];
  EXPECT_EQ(mirrored.name, "furrow_1_r");
  EXPECT_EQ(mirrored.region, "brow_r");
  EXPECT_EQ(mirrored.points[0], glm::vec3(-0.01f, 1.7f, 0.1f));
  EXPECT_EQ(mirrored.width_mm, 3.0f);
}

// The schema and bake.h have the same defaults.
TEST(StrokesFile, DefaultsEqualThoseOfTheBake) {
  const auto strokes =
      Parse(R"({"strokes": [{"name": "s", "maps": ["squash"], "points": [[0,0,0], [1,0,0]]}]})");
  ASSERT_TRUE(strokes.ok()) << strokes.status().ToString();
  const BakeStroke usual;
  const BakeStroke& read = (*strokes)[0];
  EXPECT_EQ(read.kind, usual.kind);
  EXPECT_EQ(read.smooth, usual.smooth);
  EXPECT_EQ(read.width_mm, usual.width_mm);
  EXPECT_EQ(read.depth_mm, usual.depth_mm);
  EXPECT_EQ(read.ridge, usual.ridge);
  EXPECT_EQ(read.taper, usual.taper);
  EXPECT_EQ(read.wavelength_mm, usual.wavelength_mm);
}

struct Wrong {
  const char* from;
  const char* to;
  StatusCode code;
  const char* where;
};

class StrokesFileErrors : public ::testing::TestWithParam<Wrong> {};

TEST_P(StrokesFileErrors, NameFileLineAndField) {
  const Wrong& wrong = GetParam();
  std::string text = kStrokes;
  const std::size_t at = text.find(wrong.from);
  ASSERT_NE(at, std::string::npos);
  const auto strokes = Parse(text.replace(at, std::string(wrong.from).size(), wrong.to));
  ASSERT_FALSE(strokes.ok());
  EXPECT_EQ(strokes.status().code(), wrong.code) << strokes.status().ToString();
  EXPECT_EQ(strokes.status().where(), std::string("a.json:") + wrong.where)
      << strokes.status().ToString();
}

constexpr StatusCode kSchema = StatusCode::kSchema;
constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
INSTANTIATE_TEST_SUITE_P(
    All, StrokesFileErrors,
    ::testing::Values(
        Wrong{"\"width_mm\"", "\"width\"", kSchema, "11: strokes[0].width"},
        Wrong{"\"width_mm\": 3", "\"width_mm\": 0", kInvalid, "11: strokes[0].width_mm"},
        Wrong{"\"width_mm\": 3", "\"width_mm\": \"nan\"", StatusCode::kNonFinite,
              "11: strokes[0].width_mm"},
        Wrong{"\"taper\": 0.5", "\"taper\": 1.5", kInvalid, "12: strokes[0].taper"},
        Wrong{"\"taper\": 0.5", "\"ridge\": -1", kInvalid, "12: strokes[0].ridge"},
        Wrong{"\"taper\": 0.5", "\"depth_mm\": 60", kInvalid, "12: strokes[0].depth_mm"},
        Wrong{"\"maps\": [\"stretch\"]", "\"maps\": []", kInvalid, "6: strokes[0].maps"},
        Wrong{"\"maps\": [\"stretch\"]", "\"maps\": [\"smile\"]", kInvalid,
              "6: strokes[0].maps[0]"},
        Wrong{"\"region\": \"brow_l\"", "\"region\": \"ear_l\"", kInvalid, "7: strokes[0].region"},
        Wrong{",\n                [0.03, 1.71, 0.09]", "", kInvalid, "8: strokes[0].points"},
        Wrong{"[0.01, 1.7, 0.1]", "[0.01, 1.7]", kSchema, "8: strokes[0].points[0]"},
        Wrong{"[0.01, 1.7, 0.1]", "[10, 1700, 100]", kInvalid, "8: strokes[0].points[0]"},
        Wrong{"\"name\": \"glabella\"", "\"name\": \"furrow_1_r\"", kInvalid,
              "13: strokes[1].name"},
        Wrong{"\"name\": \"glabella\", ", "", kSchema, "13: strokes[1].name"},
        Wrong{"\"direction\"", "\"sideways\"", kSchema, "13: strokes[1].kind"},
        Wrong{"\"direction\"", "9", kInvalid, "13: strokes[1].kind"},
        Wrong{"\"wavelength_mm\": 4", "\"wavelength_mm\": 0.1", kInvalid,
              "13: strokes[1].wavelength_mm"},
        Wrong{"\"strokes\": [\n", "\"version\": 2, \"strokes\": [\n", StatusCode::kUnsupported,
              "2: version"}));

TEST(StrokesFile, ReadsTheExampleInTheManual) {
  const auto manual = ReadFile(FURROW_SOURCE_DIR "/docs/BAKE.md", 1u << 20);
  ASSERT_TRUE(manual.ok());
  const std::string fence = "```json\n";
  const std::size_t begin = manual->find(fence) + fence.size();
  const std::string example = manual->substr(begin, manual->find("```", begin) - begin);
  wrinkle::Rig rig = SmallRig();
  for (const char* name : {"mouth_l", "mouth_r"}) rig.regions.emplace_back().name = name;
  const auto strokes = ParseStrokes(example, "BAKE.md", rig);
  ASSERT_TRUE(strokes.ok()) << strokes.status().ToString();
  EXPECT_EQ(strokes->size(), 4u);
}

TEST(StrokesFile, RejectsEveryTruncation) {
  const std::string text = kStrokes;
  const std::size_t end = text.rfind('}');
  for (std::size_t length = 0; length < end; ++length) {
    EXPECT_FALSE(Parse(std::string(text, 0, length)).ok()) << length;
  }
}

TEST(StrokesFile, NamesTheMissingFile) {
  const auto strokes = LoadStrokes("/nowhere/strokes.json", SmallRig());
  EXPECT_EQ(strokes.status().code(), StatusCode::kNotFound);
  EXPECT_EQ(strokes.status().where(), "/nowhere/strokes.json");
}

TEST(StrokesFile, RejectsFoldsThatAreTooDeep) {
  const auto fold = [](const std::string& fields) {
    return Parse(R"({"strokes": [{"name": "a", "maps": ["squash"], "points": [[0, 0, 0], [0, 1, 0]],
)" + fields + "}]}");
  };
  const Status steep = fold(R"("width_mm": 0.5, "depth_mm": -2.1)").status();
  EXPECT_EQ(steep.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(steep.where(), "a.json:2: strokes[0].depth_mm");
  EXPECT_NE(steep.what().find("stroke 'a' is deeper than four times"), std::string::npos);
  EXPECT_TRUE(fold(R"("width_mm": 0.5, "depth_mm": -2)").ok());
}

}  // namespace
}  // namespace furrow::authoring
