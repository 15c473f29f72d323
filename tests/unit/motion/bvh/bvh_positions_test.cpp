// SPDX-License-Identifier: Apache-2.0
#include "motion/bvh/bvh_positions.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/bvh/bvh.h"

namespace furrow::motion {
namespace {

using glm::vec3;

// A root and a chain of two joints, all with position channels. `rows`: 18 numbers per frame.
std::string Chain(const std::string& rows, int frames) {
  const std::string channels =
      "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n";
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 5 0\n" + channels + "JOINT Spine\n{\nOFFSET 0 1 0\n" +
         channels + "JOINT Head\n{\nOFFSET 0 2 0\n" + channels +
         "End Site\n{\nOFFSET 0 1 0\n}\n}\n}\n}\nMOTION\nFrames: " + std::to_string(frames) +
         "\nFrame Time: 0.1\n" + rows;
}

const std::string kZeros = "7 8 9 0 0 0  0 0 0 90 0 0  0 0 0 0 0 0\n";

Clip Parse(const std::string& text, BvhPositions positions, ClipReport* report = nullptr) {
  auto clip = ParseBvh(text, "a.bvh", {.scale = 2.0f, .bvh_positions = positions}, report);
  EXPECT_TRUE(clip.ok()) << clip.status().ToString();
  return *std::move(clip);
}

std::vector<vec3> Places(const Clip& clip, std::size_t frame) {
  std::vector<vec3> places;
  for (std::size_t j = 0; j < 3; ++j) places.push_back(clip.locals[3 * frame + j].translation);
  return places;
}

TEST(BvhPositions, ZerosOnEveryJointKeepTheOffsets) {
  ClipReport report;
  const Clip clip = Parse(Chain(kZeros + kZeros, 2), BvhPositions::kAuto, &report);
  for (const std::size_t frame : {0u, 1u}) {
    EXPECT_THAT(Places(clip, frame),
                testing::ElementsAre(vec3(14, 16, 18), vec3(0, 2, 0), vec3(0, 4, 0)));
  }
  // Rotations are read as ever.
  EXPECT_NEAR(clip.locals[1].rotation.z, std::sqrt(0.5f), 1e-6f);
  ASSERT_EQ(report.warnings.size(), 1u) << "once, not per frame";
  EXPECT_THAT(report.warnings[0], testing::HasSubstr("a.bvh: the position channels of 2 joints"));
}

// MakeHuman's own poses hold positions such as -0.000124 at an offset of 0.8.
TEST(BvhPositions, RoundedZerosAreZeros) {
  ClipReport report;
  const std::string noise = "7 8 9 0 0 0  1e-6 -4e-4 0 0 0 0  0 0.01 -2e-5 0 0 0\n";
  const Clip clip = Parse(Chain(noise, 1), BvhPositions::kAuto, &report);
  EXPECT_NEAR(Places(clip, 0)[1].y, 2.0f, 0.01f);
  EXPECT_NEAR(Places(clip, 0)[2].y, 4.0f, 0.03f);
  EXPECT_EQ(report.warnings.size(), 1u);
}

TEST(BvhPositions, TheUserDecides) {
  const std::string text = Chain(kZeros, 1);
  ClipReport report;
  EXPECT_THAT(Places(Parse(text, BvhPositions::kReplace, &report), 0),
              testing::ElementsAre(vec3(14, 16, 18), vec3(0), vec3(0)));
  EXPECT_THAT(Places(Parse(text, BvhPositions::kOffsets, &report), 0),
              testing::ElementsAre(vec3(14, 16, 18), vec3(0, 2, 0), vec3(0, 4, 0)));
  EXPECT_THAT(Places(Parse(text, BvhPositions::kAdd, &report), 0),
              testing::ElementsAre(vec3(14, 26, 18), vec3(0, 2, 0), vec3(0, 4, 0)));
  EXPECT_TRUE(report.warnings.empty());
  // Offsets win over any channel except those of a root.
  EXPECT_THAT(
      Places(Parse(Chain("7 8 9 0 0 0  0 3 0 0 0 0  0 3 0 0 0 0\n", 1), BvhPositions::kOffsets), 0),
      testing::ElementsAre(vec3(14, 16, 18), vec3(0, 2, 0), vec3(0, 4, 0)));
}

TEST(BvhPositions, RealPositionsReplaceTheOffsets) {
  ClipReport report;
  const std::string stretched = "0 0 0 0 0 0  0 1.5 0 0 0 0  0 2 0 0 0 0\n";
  EXPECT_THAT(Places(Parse(Chain(stretched, 1), BvhPositions::kAuto, &report), 0),
              testing::ElementsAre(vec3(0), vec3(0, 3, 0), vec3(0, 4, 0)));
  // One joint that meets its parent, in one of two frames, is a pose.
  const std::string meets = "0 0 0 0 0 0  0 0 0 0 0 0  0 2 0 0 0 0\n";
  EXPECT_THAT(Places(Parse(Chain(meets + stretched, 2), BvhPositions::kAuto, &report), 0),
              testing::ElementsAre(vec3(0), vec3(0), vec3(0, 4, 0)));
  EXPECT_TRUE(report.warnings.empty());
}

TEST(BvhPositions, WordsOfTheOption) {
  EXPECT_EQ(ParseBvhPositions("auto"), BvhPositions::kAuto);
  EXPECT_EQ(ParseBvhPositions("channels"), BvhPositions::kReplace);
  EXPECT_EQ(ParseBvhPositions("replace"), BvhPositions::kReplace);
  EXPECT_EQ(ParseBvhPositions("offsets"), BvhPositions::kOffsets);
  EXPECT_EQ(ParseBvhPositions("add"), BvhPositions::kAdd);
  EXPECT_EQ(ParseBvhPositions("none"), std::nullopt);
}

}  // namespace
}  // namespace furrow::motion
