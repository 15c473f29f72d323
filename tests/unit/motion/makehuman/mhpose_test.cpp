// SPDX-License-Identifier: Apache-2.0
#include "motion/makehuman/mhpose.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "tests/temporary_folder.h"

namespace furrow::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

glm::quat Turn(float degrees, const glm::vec3& axis) {
  return glm::angleAxis(glm::radians(degrees), axis);
}

// The angle between two rotations, degrees.
float AngleBetween(const glm::quat& a, const glm::quat& b) {
  return glm::degrees(2.0f * std::acos(std::min(1.0f, std::abs(glm::dot(a, b)))));
}

constexpr glm::vec3 kX{1.0f, 0.0f, 0.0f};
constexpr glm::vec3 kY{0.0f, 1.0f, 0.0f};

// Frame 0 rests, frame 1 turns the jaw by 40 degrees about X, frame 2 by 60 degrees about Y.
Clip MakeUnits() {
  Clip units;
  units.skeleton = *wrinkle::Skeleton::Create(
      {{"head", wrinkle::kNoJoint, {}, {}}, {"jaw", 0, {{0, 1, 0}, Turn(30, kY)}, {}}});
  for (int f = 0; f < 3; ++f) {
    units.times.push_back(f / 24.0);
    units.locals.push_back({{5.0f, 0.0f, 0.0f}});
    const glm::quat turn = f == 0 ? Turn(0, kX) : f == 1 ? Turn(40, kX) : Turn(60, kY);
    units.locals.push_back({{0.0f, 1.0f, 0.0f}, Turn(30, kY) * turn});
  }
  return units;
}

const std::vector<std::string> kNames{"Rest", "Open", "Left"};

TEST(ParseMhpose, ReadsNameAndUnitsInFileOrder) {
  const Result<MhPose> pose =
      ParseMhpose(R"({"name": "grin", "unit_poses": {"b": 0.5, "a": 1}, "tags": []})", "p");
  ASSERT_TRUE(pose.ok()) << pose.status().ToString();
  EXPECT_EQ(pose->name, "grin");
  EXPECT_THAT(pose->units, ElementsAre(Pair("b", 0.5f), Pair("a", 1.0f)));
}

TEST(ParseMhpose, ClampsWeightsWithAWarning) {
  ClipReport report;
  const Result<MhPose> pose =
      ParseMhpose(R"({"unit_poses": {"a": 1.5, "b": -0.25}})", "p", &report);
  ASSERT_TRUE(pose.ok());
  EXPECT_THAT(pose->units, ElementsAre(Pair("a", 1.0f), Pair("b", 0.0f)));
  EXPECT_THAT(report.warnings, ElementsAre("p: unit_poses.a is 1.5, outside [0, 1]; 1 is used",
                                           "p: unit_poses.b is -0.25, outside [0, 1]; 0 is used"));
}

TEST(ParseMhpose, RejectsOtherContent) {
  const struct {
    const char* text;
    StatusCode code;
    const char* where;
  } kCases[] = {
      {"", StatusCode::kParse, "p:1"},
      {"{\n\"unit_poses\": {\"a\": }}", StatusCode::kParse, "p:2"},
      {"[]", StatusCode::kParse, "p:1"},
      {"{}", StatusCode::kSchema, "p"},
      {R"({"unit_poses": [1]})", StatusCode::kSchema, "p: unit_poses"},
      {R"({"unit_poses": {"a": "1"}})", StatusCode::kSchema, "p: unit_poses.a"},
      {R"({"unit_poses": {"a": 1e999}})", StatusCode::kNonFinite, "p:1"},
      {R"({"unit_poses": {"a": 1, "a": 0}})", StatusCode::kSchema, "p:1"},
  };
  for (const auto& c : kCases) {
    const Status status = ParseMhpose(c.text, "p").status();
    EXPECT_EQ(status.code(), c.code) << c.text << ": " << status.ToString();
    EXPECT_EQ(status.where().rfind(c.where, 0), 0u) << status.ToString();
  }
  EXPECT_EQ(ParseMhpose(std::string(kMaxMhposeBytes + 1, ' '), "p").status().code(),
            StatusCode::kLimit);
}

TEST(ParsePoseUnitNames, NeedsAListOfNames) {
  EXPECT_THAT(*ParsePoseUnitNames(R"({"framemapping": ["Rest", "Open"]})", "n"),
              ElementsAre("Rest", "Open"));
  for (const char* text : {"{}", R"({"framemapping": []})", R"({"framemapping": [1]})"})
    EXPECT_EQ(ParsePoseUnitNames(text, "n").status().code(), StatusCode::kSchema) << text;
}

// A weight scales the angle, and later units are multiplied from the left.
TEST(BlendPoseUnits, ScalesAndMultipliesDepartures) {
  const Result<Clip> one = BlendPoseUnits({"x", {{"Open", 0.25f}}}, kNames, MakeUnits(), "p");
  ASSERT_TRUE(one.ok()) << one.status().ToString();
  EXPECT_EQ(one->name, "x");
  EXPECT_THAT(one->times, ElementsAre(0.0));
  ASSERT_EQ(one->locals.size(), 2u);
  EXPECT_EQ(one->locals[0].translation, glm::vec3(0.0f));  // of the rest pose
  EXPECT_LT(AngleBetween(one->locals[1].rotation, Turn(30, kY) * Turn(10, kX)), 0.1f);
  const Result<Clip> both =
      BlendPoseUnits({"", {{"Open", 0.5f}, {"Left", 1.0f}}}, kNames, MakeUnits(), "p");
  ASSERT_TRUE(both.ok());
  EXPECT_LT(AngleBetween(both->locals[1].rotation, Turn(30, kY) * Turn(60, kY) * Turn(20, kX)),
            0.1f);
}

TEST(BlendPoseUnits, RejectsWhatDoesNotFit) {
  const Status unknown = BlendPoseUnits({"", {{"Wink", 1.0f}}}, kNames, MakeUnits(), "p").status();
  EXPECT_EQ(unknown.code(), StatusCode::kNotFound);
  EXPECT_EQ(unknown.where(), "p: unit_poses.Wink");
  const Status few =
      BlendPoseUnits({}, {"Rest", "Open", "Left", "Right"}, MakeUnits(), "p").status();
  EXPECT_EQ(few.code(), StatusCode::kSchema);
  EXPECT_THAT(few.what(), HasSubstr("names 4 frames, but face-poseunits.bvh has 3"));
  EXPECT_EQ(BlendPoseUnits({}, kNames, Clip(), "p").status().code(), StatusCode::kSchema);
}

class MhposeFile : public testing::Test {
 protected:
  void SetUp() override {
    Write("data/expressions/open.mhpose", R"({"unit_poses": {"Open": 0.5}})");
  }
  void WriteUnits(const std::string& folder) const {
    Write(folder + "/face-poseunits.json", R"({"framemapping": ["Rest", "Open"]})");
    Write(folder + "/face-poseunits.bvh",
          "HIERARCHY\nROOT head\n{\nOFFSET 0 1 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n"
          "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n0 0 0\n40 0 0\n");
  }
  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }
  [[nodiscard]] std::filesystem::path Expression() const {
    return folder_ / "data/expressions/open.mhpose";
  }
  TemporaryFolder folder_;
};

TEST_F(MhposeFile, FindsPoseUnitsInTheFolderBeside) {
  const Status missing = LoadClip(Expression()).status();
  EXPECT_EQ(missing.code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.ToString(), HasSubstr("FURROW_ASSET_PATH"));
  WriteUnits("data/poseunits");
  const Result<Clip> clip = LoadClip(Expression());
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_EQ(clip->name, "open");  // the file states no name
  EXPECT_EQ(clip->num_frames(), 1);
  EXPECT_LT(AngleBetween(clip->locals[0].rotation, Turn(20, kX)), 0.1f);
}

TEST_F(MhposeFile, FindsPoseUnitsOnTheAssetPath) {
  WriteUnits("elsewhere/poseunits");
  for (const char* folder : {"elsewhere", "elsewhere/poseunits"}) {
    ::setenv("FURROW_ASSET_PATH", (folder_ / folder).c_str(), 1);
    const Result<Clip> clip = LoadClip(Expression());
    EXPECT_TRUE(clip.ok()) << folder << ": " << clip.status().ToString();
  }
  ::unsetenv("FURROW_ASSET_PATH");
}

TEST(MhposeSharedData, EveryExpressionIsRead) {
  const std::filesystem::path folder =
      std::filesystem::path(FURROW_SHARED_DATA) / "makehuman/expressions";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    ClipReport report;
    const Result<Clip> clip = LoadClip(entry.path(), {}, &report);
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    EXPECT_EQ(clip->name, entry.path().stem().string());
    EXPECT_EQ(clip->skeleton.num_joints(), 163);
    EXPECT_EQ(clip->num_frames(), 1);
    EXPECT_THAT(report.warnings, ElementsAre());
    ++count;
  }
  EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace furrow::motion
