// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhm.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

constexpr const char* kSave =
    "# Written by MakeHuman 1.2.0\n"
    "version v1.2.0\n"
    "name Old woman\n"
    "tags a;b\n"
    "camera 0.0 0.0 0.0 0.0 0.0 1.0\n"
    "modifier macrodetails/Age 0.9\n"
    "modifier nose/nose-hump-decr|incr -0.25\n"
    "modifier macrodetails/Age 0.95\n"
    "eyes HighPolyEyes 2c12f43b-1303-432c-b7ce-d78346baf2e6\n"
    "clothes My best shirt 79ced554-1d8a-4c14-a6a8-e1de90b09c32\n"
    "clothesHideFaces False\n"
    "skinMaterial skins/old woman/skin.mhmat\n"
    "material My best shirt 79ced554-1d8a-4c14-a6a8-e1de90b09c32 ../red shirt.mhmat\n"
    "skeleton game_engine.mhskel\n"
    "subdivide False\n";

TEST(ParseMhm, ReadsWhatTheUserChose) {
  const Result<MhmSave> save = ParseMhm(kSave, "a.mhm");
  ASSERT_TRUE(save.ok()) << save.status().ToString();
  EXPECT_EQ(save->name, "Old woman");
  EXPECT_EQ(save->version, "v1.2.0");
  ASSERT_EQ(save->modifiers.size(), 2u);  // the later line replaces the earlier one
  EXPECT_EQ(save->modifiers[0].name, "macrodetails/Age");
  EXPECT_FLOAT_EQ(save->modifiers[0].value, 0.95f);
  EXPECT_FLOAT_EQ(save->modifiers[1].value, -0.25f);
  ASSERT_EQ(save->parts.size(), 2u);
  EXPECT_EQ(save->parts[0].kind, "eyes");
  EXPECT_EQ(save->parts[0].uuid, "2c12f43b-1303-432c-b7ce-d78346baf2e6");
  EXPECT_EQ(save->parts[1].name, "My best shirt");
  ASSERT_EQ(save->materials.size(), 1u);
  EXPECT_EQ(save->materials[0].name, "My best shirt");
  EXPECT_EQ(save->materials[0].path, "../red shirt.mhmat");
  EXPECT_EQ(save->skin_material, "skins/old woman/skin.mhmat");
  EXPECT_EQ(save->skeleton, "game_engine.mhskel");
  EXPECT_FALSE(save->clothes_hide_faces);
  EXPECT_TRUE(save->warnings.empty()) << save->warnings.front();
}

TEST(ParseMhm, SaysWhatHasNoEffect) {
  const Result<MhmSave> save = ParseMhm(
      "version v1.2.0\nmodifier head/head-oval 2\npose run01.bvh\nproxy female_generic x\n"
      "surprise 1\nhair\n",
      "a.mhm");
  ASSERT_TRUE(save.ok()) << save.status().ToString();
  EXPECT_FLOAT_EQ(save->modifiers[0].value, 1.0f);
  ASSERT_EQ(save->warnings.size(), 5u);
  EXPECT_EQ(save->warnings[0].rfind("a.mhm:2: the value 2 is outside [-1, 1]", 0), 0u);
  EXPECT_NE(save->warnings[1].find("recording"), std::string::npos);
  EXPECT_NE(save->warnings[2].find("export the person from MakeHuman as FBX"), std::string::npos);
  EXPECT_NE(save->warnings[3].find("'surprise'"), std::string::npos);
  EXPECT_EQ(save->warnings[4].rfind("a.mhm:6: ", 0), 0u);
}

TEST(ParseMhm, NamesOfModifiersMayContainBlanks) {
  const Result<MhmSave> save = ParseMhm("modifier Upper Face AUs/4 0.5\n", "a.mhm");
  ASSERT_TRUE(save.ok()) << save.status().ToString();
  EXPECT_EQ(save->modifiers[0].name, "Upper Face AUs/4");
  EXPECT_FLOAT_EQ(save->modifiers[0].value, 0.5f);
}

// Saves of MakeHuman 1.0 alpha have lines of other kinds.
TEST(ParseMhm, SaysThatASaveIsTooOld) {
  const Result<MhmSave> save =
      ParseMhm("version 1.0.0\ngender 0.0\ndetail nose-scale-horiz-incr 0.3\n", "a.mhm");
  ASSERT_TRUE(save.ok());
  EXPECT_NE(save->warnings.back().find("no modifiers"), std::string::npos);
  const Result<MhmSave> first = ParseMhm("version v1.0.2\nmodifier a/b 1\n", "a.mhm");
  ASSERT_TRUE(first.ok());
  ASSERT_EQ(first->warnings.size(), 1u);
  EXPECT_NE(first->warnings[0].find("'v1.0.2'"), std::string::npos);
}

TEST(ParseMhm, WarningsAreBoundedAndCounted) {
  std::string text = "modifier a/b 1\n";
  for (int i = 0; i < 100; ++i) text += "what is this\n";
  const Result<MhmSave> save = ParseMhm(text, "a.mhm");
  ASSERT_TRUE(save.ok());
  ASSERT_EQ(save->warnings.size(), 17u);
  EXPECT_NE(save->warnings.back().find("84 more warnings"), std::string::npos);
}

TEST(ParseMhm, RejectsWithTheLine) {
  const auto status = [](const std::string& text) { return ParseMhm(text, "a.mhm").status(); };
  EXPECT_EQ(status("version 1\nmodifier a/b nan\n").code(), StatusCode::kNonFinite);
  EXPECT_EQ(status("version 1\nmodifier a/b x\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("version 1\nmodifier a/b\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("version 1\nmodifier a/b\n").where(), "a.mhm:2");
  EXPECT_EQ(status("").code(), StatusCode::kSchema);
  EXPECT_EQ(status("\x01garbage\xff\n").code(), StatusCode::kSchema);
  EXPECT_EQ(status("name " + std::string(300, 'x')).code(), StatusCode::kLimit);
  EXPECT_EQ(status(std::string(kMaxMhmBytes + 1, '\n')).code(), StatusCode::kLimit);
  std::string many;
  for (std::size_t i = 0; i <= kMaxMhmModifiers; ++i)
    many += "modifier a/b" + std::to_string(i) + " 1\n";
  EXPECT_EQ(status(many).code(), StatusCode::kLimit);
  many.clear();
  for (std::size_t i = 0; i <= kMaxMhmParts; ++i) many += "clothes a b\n";
  EXPECT_EQ(status(many).code(), StatusCode::kLimit);
}

TEST(ParseMhm, EveryPrefixIsReadOrRejected) {
  const std::string text = kSave;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::string prefix = text.substr(0, length);
    const Result<MhmSave> save = ParseMhm(prefix, "a.mhm");
    if (!save.ok()) EXPECT_FALSE(save.status().where().empty()) << length;
  }
}

// Messages and files show names, so control characters do not get through.
TEST(ParseMhm, NamesAreClean) {
  const Result<MhmSave> save = ParseMhm("modifier a\x1b[2J/b 1\nhair \x1b]0;x\x07 id\n", "a.mhm");
  ASSERT_TRUE(save.ok());
  EXPECT_EQ(save->modifiers[0].name, "a?[2J/b");
  EXPECT_EQ(save->parts[0].name, "?]0;x?");
}

}  // namespace
}  // namespace furrow::authoring
