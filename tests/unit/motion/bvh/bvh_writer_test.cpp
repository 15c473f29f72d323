// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/bvh/bvh.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using ::testing::HasSubstr;
using wrinkle::JointDesc;
using wrinkle::kNoJoint;
using wrinkle::Skeleton;
using wrinkle::Transform;

glm::quat Turn(float degrees, const glm::vec3& axis) {
  return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

// A skeleton like those of glTF files: two roots, a fork, rest rotations, a scaled root.
Clip MakeClip() {
  const Transform arm{{1.0f, 0.2f, 0.0f}, Turn(70.0f, {1, 2, 3}), glm::vec3(1.0f)};
  std::vector<JointDesc> joints = {
      {"root", kNoJoint, {{0.0f, 1.0f, 0.0f}, Turn(-90.0f, {1, 0, 0}), glm::vec3(0.5f)}, {}},
      {"left", 0, arm, {}},
      {"right", 0, {{-1.0f, 0.2f, 0.0f}, Turn(20.0f, {0, 1, 1}), glm::vec3(1.0f)}, {}},
      {"hand", 1, {{0.0f, 2.0f, 0.5f}, Turn(180.0f, {0, 0, 1}), glm::vec3(1.0f)}, {{0.1f, 0, 0}}},
      {"prop", kNoJoint, {}, {{0.0f, 0.0f, 1.0f}}}};
  Clip clip;
  clip.skeleton = *Skeleton::Create(joints);
  for (int f = 0; f < 40; ++f) {
    const auto t = static_cast<float>(f);
    for (int j = 0; j < clip.skeleton.num_joints(); ++j) {
      Transform local = clip.skeleton.rest_pose()[static_cast<std::size_t>(j)];
      // Passes gimbal lock (Y at 90 degrees) and 360 degrees.
      local.rotation = local.rotation * Turn(t * 15.0f, {0, 1, 0}) *
                       Turn(t * 7.0f, {1.0f, static_cast<float>(j), 0.5f});
      if (j == 0 || j == 2) local.translation += glm::vec3(0.1f * t, 0.0f, -0.05f * t);
      clip.locals.push_back(local);
    }
    clip.times.push_back(f / 60.0);
  }
  return clip;
}

Clip Rewrite(const Clip& clip, std::string* text = nullptr) {
  const Result<std::string> written = BvhToText(clip);
  EXPECT_TRUE(written.ok()) << written.status().ToString();
  if (text != nullptr) *text = *written;
  Result<Clip> read = ParseBvh(*written, "rewritten.bvh");
  EXPECT_TRUE(read.ok()) << read.status().ToString();
  return std::move(*read);
}

TEST(BvhWriter, KeepsPositionsWithoutRestRotationsAndScales) {
  const Clip clip = MakeClip();
  const Clip read = Rewrite(clip);
  ASSERT_EQ(read.num_frames(), clip.num_frames());
  EXPECT_LT(WorstDistance(clip, read), 2e-5f);
  for (const Transform& rest : read.skeleton.rest_pose()) {
    EXPECT_EQ(rest.rotation, glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
  }
}

TEST(BvhWriter, KeepsTheRestPoseAndDeviationsFromIt) {
  const Clip clip = MakeClip();
  const Clip read = Rewrite(clip);
  for (int j = 0; j < clip.skeleton.num_joints(); ++j) {
    const auto a = static_cast<std::size_t>(j);
    const auto b = static_cast<std::size_t>(read.skeleton.Find(clip.skeleton.joint_names()[a]));
    const glm::vec3 rest(clip.skeleton.rest_model()[a][3]);
    EXPECT_LT(glm::length(rest - glm::vec3(read.skeleton.rest_model()[b][3])), 1e-5f);
    const glm::vec3 tail(clip.skeleton.rest_model()[a] * glm::vec4(clip.skeleton.tails()[a], 1.0f));
    const bool leaf =
        clip.skeleton.joint_names()[a] == "hand" || clip.skeleton.joint_names()[a] == "prop";
    if (leaf) {
      const glm::vec3 other(read.skeleton.rest_model()[b] *
                            glm::vec4(read.skeleton.tails()[b], 1.0f));
      EXPECT_LT(glm::length(tail - other), 1e-5f);
    }
    // The deviation from the rest pose in model axes, which JointDelta uses.
    const auto departure = [](const Clip& c, std::size_t joint) {
      glm::mat3 axes(ModelMatrices(c, 17)[joint]);
      for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(axes[i]);
      return glm::quat_cast(axes) * glm::inverse(c.skeleton.rest_model_rotations()[joint]);
    };
    EXPECT_GT(std::abs(glm::dot(departure(clip, a), departure(read, b))), 1.0f - 1e-5f);
  }
}

TEST(BvhWriter, RoundTripIsExactToTheWrittenDecimals) {
  for (const char* name : {"cmu/01_01.bvh", "performances/emotions.bvh"}) {
    if (!std::filesystem::exists(SharedFile(name))) GTEST_SKIP() << name << " is not there";
    const Result<Clip> clip = ParseBvh(ReadAll(SharedFile(name)), name);
    ASSERT_TRUE(clip.ok());
    std::string text;
    const Clip read = Rewrite(*clip, &text);
    ASSERT_EQ(read.num_frames(), clip->num_frames());
    const float worst = WorstDistance(*clip, read);
    std::printf("%s: worst distance after a round trip %.2e\n", name, static_cast<double>(worst));
    EXPECT_LT(worst, 2e-5f);
    EXPECT_NEAR(read.times.back(), clip->times.back(), 1e-6);
    EXPECT_EQ(read.skeleton.hash(), clip->skeleton.hash());
    // A second text differs at most in the last decimal of a few angles.
    EXPECT_NEAR(static_cast<double>(text.size()), static_cast<double>(BvhToText(read)->size()),
                0.001 * static_cast<double>(text.size()));
  }
}

TEST(BvhWriter, AnglesDoNotJump) {
  const Clip clip = MakeClip();
  const Result<std::string> text = BvhToText(clip);
  ASSERT_TRUE(text.ok());
  // "prop" turns at constant speed. No angle may change by more than half a turn per frame.
  std::istringstream stream(text->substr(text->find("Frame Time")));
  std::string line;
  std::getline(stream, line);
  std::vector<double> before;
  while (std::getline(stream, line)) {
    std::istringstream numbers(line);
    std::vector<double> values((std::istream_iterator<double>(numbers)), {});
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_LE(std::abs(values[i] - before[i]), 180.0);
    before = values;
  }
  EXPECT_EQ(before.size(), 3u * 6u + 2u * 3u);  // both roots and "right" have position channels
}

TEST(BvhWriter, ResamplesUnevenFrames) {
  Clip clip = MakeClip();
  clip.times[20] += 0.25 / 60.0;
  ClipReport report;
  const Result<std::string> text = BvhToText(clip, &report);
  ASSERT_TRUE(text.ok());
  EXPECT_THAT(report.warnings, testing::ElementsAre(HasSubstr("resampled")));
  EXPECT_EQ(ParseBvh(*text, "t.bvh")->num_frames(), 40);
}

TEST(BvhWriter, RejectsClipsThatBvhCannotExpress) {
  Clip shapes;
  shapes.blend_shape_names = {"jawOpen"};
  shapes.times = {0.0};
  shapes.blend_shapes = {1.0f};
  EXPECT_EQ(BvhToText(shapes).status().code(), StatusCode::kUnsupported);

  Clip scaled = MakeClip();
  scaled.locals[7].scale = glm::vec3(1.0f, 2.0f, 1.0f);
  EXPECT_EQ(BvhToText(scaled).status().code(), StatusCode::kUnsupported);

  Clip empty = MakeClip();
  empty.times.clear();
  empty.locals.clear();
  EXPECT_EQ(BvhToText(empty).status().code(), StatusCode::kInvalidArgument);

  for (const char* name : {"a{b", "a\nb", " a"}) {
    Clip named;
    named.skeleton = *Skeleton::Create({{name, kNoJoint, {}, {}}});
    named.times = {0.0};
    named.locals = {{}};
    EXPECT_EQ(BvhToText(named).status().code(), StatusCode::kInvalidArgument) << name;
  }
}

}  // namespace
}  // namespace furrow::motion
