// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/bvh/bvh.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two joints, each one unit along X, and an End Site after another half unit.
std::string Arm(const std::string& root_channels, const std::string& child_channels,
                const std::string& motion) {
  return "HIERARCHY\nROOT Upper\n{\n\tOFFSET 1 2 3\n\tCHANNELS " + root_channels +
         "\n\tJOINT Lower\n\t{\n\t\tOFFSET 1 0 0\n\t\tCHANNELS " + child_channels +
         "\n\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0.5 0 0\n\t\t}\n\t}\n}\nMOTION\n" + motion;
}

constexpr const char* kZxy = "3 Zrotation Xrotation Yrotation";

void ExpectNear(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Clip Parse(const std::string& text, const LoadOptions& options = {}, ClipReport* report = nullptr) {
  Result<Clip> clip = ParseBvh(text, "t.bvh", options, report);
  EXPECT_TRUE(clip.ok()) << clip.status().ToString();
  return clip.ok() ? std::move(*clip) : Clip();
}

TEST(BvhReader, ReadsHierarchyTailsAndTimes) {
  const Clip clip = Parse(Arm(kZxy, kZxy,
                              "Frames: 2\nFrame Time: .0083333\n0 0 0 0 0 0\n"
                              "90 0 0 0 0 0\n"));
  EXPECT_THAT(clip.skeleton.joint_names(), ElementsAre("Upper", "Lower"));
  EXPECT_THAT(clip.skeleton.joint_parents(), ElementsAre(wrinkle::kNoJoint, 0));
  ExpectNear(clip.skeleton.tails()[1], {0.5f, 0.0f, 0.0f});
  EXPECT_THAT(clip.times, ElementsAre(0.0, 0.0083333));
  // A quarter turn about Z moves the child from +X to +Y.
  ExpectNear(ModelPosition(clip, 0, "Lower"), {2.0f, 2.0f, 3.0f});
  ExpectNear(ModelPosition(clip, 1, "Lower"), {1.0f, 3.0f, 3.0f});
}

// R = R1 * R2 * R3 in the joint's own order. Computed by hand: with Z
// first, v = Rz(90) Rx(90) (0,1,0) = Rz(90) (0,0,1) = (0,0,1); with
// X first, v = Rx(90) Rz(90) (0,1,0) = Rx(90) (-1,0,0) = (-1,0,0).
TEST(BvhReader, UsesTheChannelOrderOfEachJoint) {
  const std::string head = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS ";
  const std::string tail =
      "\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n90 90 0\n";
  const Clip z_first = Parse(head + "3 Zrotation Xrotation Yrotation" + tail);
  const Clip x_first = Parse(head + "3 Xrotation Zrotation Yrotation" + tail);
  ExpectNear(z_first.locals[0].rotation * glm::vec3(0, 1, 0), {0.0f, 0.0f, 1.0f});
  ExpectNear(x_first.locals[0].rotation * glm::vec3(0, 1, 0), {-1.0f, 0.0f, 0.0f});
}

TEST(BvhReader, ReadsZeroOneThreeAndSixChannelJointsInOneFile) {
  const std::string text =
      "HIERARCHY\nROOT R\n{\nOFFSET 0 0 0\n"
      "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
      "JOINT None\n{\nOFFSET 0 1 0\nCHANNELS 0\nJOINT One\n{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n"
      "JOINT Bare\n{\nOFFSET 0 1 0\nJOINT Three\n{\nOFFSET 0 0 0\nCHANNELS 3 Yrotation Zrotation "
      "Xrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 1\n10 20 30 0 0 0 90 0 90 0\n";
  const Clip clip = Parse(text);
  ASSERT_EQ(clip.skeleton.num_joints(), 5);
  ExpectNear(ModelPosition(clip, 0, "One"), {10.0f, 22.0f, 30.0f});
  // `One` turns +Y to +Z: 90 degrees about X.
  ExpectNear(ModelPosition(clip, 0, "Bare"), {10.0f, 22.0f, 31.0f});
  ExpectNear(ModelPosition(clip, 0, "Three"), {10.0f, 22.0f, 31.0f});
}

TEST(BvhReader, PositionChannelsReplaceTheOffsetOrAddToIt) {
  const std::string text = Arm("4 Xposition Yposition Zrotation Xrotation", "0",
                               "Frames: 1\nFrame Time: 1\n10 20 0 0\n");
  // Z has no channel, so its offset stays in both cases.
  ExpectNear(Parse(text).locals[0].translation, {10.0f, 20.0f, 3.0f});
  const Clip added = Parse(text, {.bvh_positions = BvhPositions::kAdd});
  ExpectNear(added.locals[0].translation, {11.0f, 22.0f, 3.0f});
}

TEST(BvhReader, ScalesEveryLength) {
  const Clip clip = Parse(Arm("6 Xposition Yposition Zposition Zrotation Yrotation Xrotation", "0",
                              "Frames: 1\nFrame Time: 1\n10 20 30 0 0 0\n"),
                          {.scale = 0.5f});
  ExpectNear(clip.skeleton.rest_pose()[0].translation, {0.5f, 1.0f, 1.5f});
  ExpectNear(clip.skeleton.tails()[1], {0.25f, 0.0f, 0.0f});
  ExpectNear(ModelPosition(clip, 0, "Lower"), {5.5f, 10.0f, 15.0f});
}

TEST(BvhReader, ReadsSeveralRoots) {
  const std::string root =
      "{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n";
  const Clip clip = Parse("HIERARCHY\nROOT A\n" + root + "ROOT B\n" + root +
                          "MOTION\nFrames: 1\nFrame Time: 1\n10 20\n");
  EXPECT_THAT(clip.skeleton.joint_parents(), ElementsAre(wrinkle::kNoJoint, wrinkle::kNoJoint));
  EXPECT_NEAR(2.0 * std::asin(clip.locals[1].rotation.x), 20.0 * M_PI / 180.0, 1e-6);
}

TEST(BvhReader, AcceptsAnyCaseTabsBlanksAndLineEnds) {
  const std::string text =
      "\xEF\xBB\xBFhierarchy\r\nRoot  Bip01 Pelvis \t\r\n{\r\n\t\tOffset\t0.0 \t1e0 0 \r\n"
      "channels 3 ZROTATION xrotation Yrotation   \r\nend site\r\n{\r\noffset 0 1 "
      "0\r\n}\r\n}\r\n\r\n"
      "Motion\r\nframes :\t2 \r\nFRAME   TIME: 3.3e-2\r\n1 2 3   \t\r\n\r\n4\t5 6\r\n\r\n";
  ClipReport report;
  const Clip clip = Parse(text, {}, &report);
  EXPECT_THAT(clip.skeleton.joint_names(), ElementsAre("Bip01 Pelvis"));
  EXPECT_EQ(clip.num_frames(), 2);
  EXPECT_DOUBLE_EQ(clip.times[1], 0.033);
  EXPECT_THAT(report.warnings, ElementsAre());
  // The same text with carriage returns only.
  std::string old_mac = text;
  std::erase(old_mac, '\n');
  EXPECT_EQ(Parse(old_mac).num_frames(), 2);
}

TEST(BvhReader, ReadsVeryLongLines) {
  std::string text = "HIERARCHY\n";
  const int kJoints = 1000;
  for (int i = 0; i < kJoints; ++i) {
    text += (i == 0 ? "ROOT j" : "JOINT j") + std::to_string(i) + "\n{\nOFFSET 0 0 0\nCHANNELS " +
            kZxy + "\n";
  }
  text += std::string("End Site\n{\nOFFSET 0 1 0\n}\n");
  for (int i = 0; i < kJoints; ++i) text += "}\n";
  text += "MOTION\nFrames: 1\nFrame Time: 1\n";
  for (int i = 0; i < 3 * kJoints; ++i) text += "0.00000000000000000000" + std::string(40, ' ');
  EXPECT_GT(text.size(), 150'000u);
  EXPECT_EQ(Parse(text + "\n").skeleton.num_joints(), kJoints);
}

TEST(BvhReader, AcceptsJointsAndSitesOfLengthZero) {
  const std::string text =
      "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT B\n{\nOFFSET 0 0 0\n"
      "CHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 -0 0\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 1\n45\n";
  const Clip clip = Parse(text);
  ExpectNear(ModelPosition(clip, 0, "B"), {0.0f, 0.0f, 0.0f});
}

TEST(BvhReader, WarnsOfAWrongFrameCount) {
  const std::string rows = "0 0 0 0 0 0\n0 0 0 0 0 0\n";
  for (const char* stated : {"1", "3"}) {
    ClipReport report;
    const Clip clip =
        Parse(Arm(kZxy, kZxy, "Frames: " + std::string(stated) + "\nFrame Time: 1\n" + rows), {},
              &report);
    EXPECT_EQ(clip.num_frames(), 2);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_THAT(report.warnings[0], HasSubstr("holds 2"));
  }
}

TEST(BvhReader, KeepsTheSignOfQuaternions) {
  std::string motion = "Frames: 73\nFrame Time: 1\n";
  for (int i = 0; i <= 72; ++i) motion += std::to_string(i * 10 % 360 - 180) + " 0 0 0 0 0\n";
  const Clip clip = Parse(Arm(kZxy, kZxy, motion));
  for (std::size_t f = 1; f < clip.times.size(); ++f) {
    EXPECT_GT(glm::dot(clip.locals[2 * f].rotation, clip.locals[2 * f - 2].rotation), 0.99f) << f;
  }
}

struct Broken {
  const char* what;
  std::string text;
  StatusCode code;
  const char* where;
};

TEST(BvhReader, NamesTheLineOfEveryError) {
  const std::string good = Arm(kZxy, kZxy, "Frames: 2\nFrame Time: 1\n0 0 0 0 0 0\n");
  const auto with = [&good](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const Broken kCases[] = {
      {"short line", good + "0 0 0 0 0\n", StatusCode::kParse, "t.bvh:20"},
      {"long line", good + "0 0 0 0 0 0 0\n", StatusCode::kParse, "t.bvh:20"},
      {"nan", good + "0 0 nan 0 0 0\n", StatusCode::kNonFinite, "t.bvh:20"},
      {"infinite offset", with("1 2 3", "1 inf 3"), StatusCode::kNonFinite, "t.bvh:4"},
      {"word", good + "0 0 x 0 0 0\n", StatusCode::kParse, "t.bvh:20"},
      {"comma", good + "0 0 1,5 0 0 0\n", StatusCode::kParse, "t.bvh:20"},
      {"count of channels too small", with("3 Z", "2 Z"), StatusCode::kParse, "t.bvh:5"},
      {"count of channels too large", with("3 Z", "4 Z"), StatusCode::kParse, "t.bvh:6"},
      {"seven channels", with("3 Z", "7 Z"), StatusCode::kParse, "t.bvh:5"},
      {"half a channel", with("3 Z", "2.5 Z"), StatusCode::kParse, "t.bvh:5"},
      {"scale channel", with("Zrotation", "Zscale"), StatusCode::kUnsupported, "t.bvh:5"},
      {"same name twice", with("JOINT Lower", "JOINT Upper"), StatusCode::kParse, "t.bvh:6"},
      {"no name", with("JOINT Lower", "JOINT"), StatusCode::kParse, "t.bvh:6"},
      {"no offset", with("OFFSET 1 2 3", ""), StatusCode::kParse, "t.bvh:15"},
      {"unknown keyword", with("OFFSET 1 2 3", "OFSET 1 2 3"), StatusCode::kParse, "t.bvh:4"},
      {"brace too many", with("MOTION", "}\nMOTION"), StatusCode::kParse, "t.bvh:16"},
      {"frame time", with("Frame Time: 1", "Frame Time: -1"), StatusCode::kParse, "t.bvh:18"},
      {"frames", with("Frames: 2", "Frames: many"), StatusCode::kParse, "t.bvh:17"},
      {"frames", with("Frames: 2", "Frames: 1e12"), StatusCode::kLimit, "t.bvh:17"},
      {"no frames", with("0 0 0 0 0 0\n", ""), StatusCode::kParse, "t.bvh:19"}};
  for (const Broken& broken : kCases) {
    const Result<Clip> clip = ParseBvh(broken.text, "t.bvh");
    ASSERT_FALSE(clip.ok()) << broken.what;
    EXPECT_EQ(clip.status().code(), broken.code) << broken.what << clip.status().ToString();
    EXPECT_EQ(clip.status().where(), broken.where) << broken.what << clip.status().ToString();
  }
}

TEST(BvhReader, RejectsTooManyJoints) {
  std::string text = "HIERARCHY\n";
  for (int i = 0; i <= wrinkle::kMaxJoints; ++i) {
    text += (i == 0 ? "ROOT j" : "JOINT j") + std::to_string(i) + " {\nOFFSET 0 0 0\nCHANNELS 0\n";
  }
  const Result<Clip> clip = ParseBvh(text, "t.bvh");
  ASSERT_FALSE(clip.ok());
  EXPECT_EQ(clip.status().code(), StatusCode::kLimit);
}

// A cut file is an error, unless only blanks or the newline after the last line are missing. Each
// length gets its own buffer, so that the address sanitizer finds reads past the end.
TEST(BvhReader, RejectsEveryTruncation) {
  const std::string whole = Arm(kZxy, kZxy, "Frames: 2\nFrame Time: 1\n0 0 0 0 0 0\n1 2 3 4 5 6\n");
  int accepted = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    const Result<Clip> clip = ParseBvh({cut.data(), cut.size()}, "t.bvh");
    if (!clip.ok()) {
      EXPECT_THAT(clip.status().where(), HasSubstr("t.bvh:"));
      continue;
    }
    ++accepted;
    const bool one_frame_and_newline = length == whole.size() - 12;
    EXPECT_TRUE(one_frame_and_newline || length == whole.size() - 1) << length;
  }
  EXPECT_EQ(accepted, 2);
}

TEST(BvhReader, SurvivesGarbage) {
  std::uint32_t state = 1;
  const std::string good = Arm(kZxy, kZxy, "Frames: 1\nFrame Time: 1\n0 0 0 0 0 0\n");
  for (int round = 0; round < 2000; ++round) {
    std::string text = good;
    for (int i = 0; i < 4; ++i) {
      state = state * 1664525u + 1013904223u;
      text[(state >> 8) % text.size()] = static_cast<char>(state >> 24);
    }
    const Result<Clip> clip = ParseBvh(text, "t.bvh");
    if (clip.ok()) {
      for (const wrinkle::Transform& local : clip->locals) EXPECT_TRUE(wrinkle::IsValid(local));
    } else {
      EXPECT_NE(clip.status().what(), "");
    }
  }
}

}  // namespace
}  // namespace furrow::motion
