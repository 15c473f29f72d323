// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/floor.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/motion/clip/offset_joint.h"

namespace furrow::motion {
namespace {

// A body with legs of length 0.9, whose hips rest and move at these heights.
Clip Body(float rest, const std::vector<float>& heights, const char* head = "Head") {
  Clip clip;
  clip.skeleton = *wrinkle::Skeleton::Create({OffsetJoint("Hips", -1, {0.1f, rest, 0.2f}),
                                              OffsetJoint(head, 0, {0, 0.6f, 0}),
                                              OffsetJoint("Foot", 0, {0, -0.9f, 0})});
  for (std::size_t i = 0; i < heights.size(); ++i) {
    clip.times.push_back(0.1 * static_cast<double>(i));
    const auto pose = clip.skeleton.rest_pose();
    clip.locals.insert(clip.locals.end(), pose.begin(), pose.end());
    clip.locals[3 * i].translation = {0.5f, heights[i], 0.7f};
  }
  return clip;
}

std::vector<float> HipsOf(const Clip& clip) {
  std::vector<float> heights{clip.skeleton.rest_pose()[0].translation.y};
  for (std::size_t i = 0; i < clip.locals.size(); i += 3)
    heights.push_back(clip.locals[i].translation.y);
  return heights;
}

void ExpectHips(const Clip& clip, const std::vector<float>& wanted) {
  const std::vector<float> heights = HipsOf(clip);
  ASSERT_EQ(heights.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(heights[i], wanted[i], 1e-6f) << i;
}

TEST(Floor, TheLowestJointOfAllFramesTouchesIt) {
  Clip clip = Body(0.06f, {0.0f, -0.2f, 0.3f});  // stands, squats and jumps, around its hips
  const auto raised = RaiseToFloor(&clip);
  ASSERT_TRUE(raised.ok());
  EXPECT_TRUE(*raised);
  ExpectHips(clip, {0.9f, 1.1f, 0.9f, 1.4f});
  EXPECT_FLOAT_EQ(clip.locals[3].translation.x, 0.5f) << "only the height changes";
  EXPECT_FLOAT_EQ(clip.locals[4].translation.y, 0.6f) << "only roots move";
  EXPECT_FALSE(*RaiseToFloor(&clip)) << "it stands on the floor now";
}

TEST(Floor, ARootThatStaysAtRestStatesNoPosition) {
  Clip clip = Body(0.06f, {0.06f, 0.06f});
  for (std::size_t i = 0; i < clip.locals.size(); i += 3)
    clip.locals[i] = clip.skeleton.rest_pose()[0];
  const auto raised = RaiseToFloor(&clip);
  ASSERT_TRUE(raised.ok());
  EXPECT_FALSE(*raised) << "nothing to report";
  ExpectHips(clip, {0.9f, 0.9f, 0.9f});
}

TEST(Floor, LegsNeedNoNames) {
  Clip clip;
  std::vector<wrinkle::JointDesc> joints = {
      OffsetJoint("a", -1, {}), OffsetJoint("b", 0, {0, 0.3f, 0}),
      OffsetJoint("c", 1, {0, 0.3f, 0}), OffsetJoint("d", 2, {0, 0.2f, 0})};
  std::vector<std::string> names;
  for (int i = 0; i < 12; ++i) names.push_back("limb" + std::to_string(i));
  const auto limb = [&](int parent, glm::vec3 start, glm::vec3 bone) {
    for (int i = 0; i < 3; ++i) {
      joints.push_back(OffsetJoint(names[joints.size() - 4].c_str(),
                                   i == 0 ? parent : static_cast<int>(joints.size()) - 1,
                                   i == 0 ? start : bone));
    }
  };
  for (const float side : {0.1f, -0.1f}) {
    limb(0, {side, 0, 0}, {0, -0.45f, 0});
    limb(2, {side, 0, 0}, {3.0f * side, 0, 0});
  }
  clip.skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  clip.times = {0.0};
  clip.locals.assign(clip.skeleton.rest_pose().begin(), clip.skeleton.rest_pose().end());
  ASSERT_TRUE(RaiseToFloor(&clip).ok());
  EXPECT_NEAR(clip.locals[0].translation.y, 0.9f, 1e-6f);
}

TEST(Floor, OthersStayAsTheyAre) {
  const auto stays = [](Clip clip) {
    const std::vector<float> before = HipsOf(clip);
    const auto raised = RaiseToFloor(&clip);
    return raised.ok() && !*raised && HipsOf(clip) == before;
  };
  EXPECT_TRUE(stays(Body(0.0f, {0.9f, 0.8f}))) << "only the motion states the height";
  EXPECT_TRUE(stays(Body(0.9f, {0.7f}))) << "a shallow hole in the floor, or an inexact one";
  EXPECT_TRUE(stays(Body(0.9f, {3.0f}))) << "somebody may fly";
  EXPECT_TRUE(stays(Body(0.0f, {0.0f}, "Top"))) << "no head";
  EXPECT_TRUE(stays(Body(0.0f, {}))) << "no frames";
  Clip nothing;
  EXPECT_FALSE(*RaiseToFloor(&nothing));
  Clip bust = Body(0.0f, {0.0f});
  bust.skeleton = *wrinkle::Skeleton::Create({OffsetJoint("Chest", -1, {0, 0, 0}),
                                              OffsetJoint("Head", 0, {0, 0.6f, 0}),
                                              OffsetJoint("Hand", 0, {0, -0.2f, 0})});
  bust.locals.assign(bust.skeleton.rest_pose().begin(), bust.skeleton.rest_pose().end());
  EXPECT_TRUE(stays(bust)) << "no legs";
}

TEST(Floor, LoadClipRaisesBvhAndSaysSo) {
  const TemporaryFolder folder;
  const auto path = folder / "clip.bvh";
  std::ofstream(path) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\n"
                         "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
                         "JOINT Head\n{\nOFFSET 0 6 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                         "End Site\n{\nOFFSET 0 1 0\n}\n}\n"
                         "JOINT Foot\n{\nOFFSET 0 -9 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                         "End Site\n{\nOFFSET 0 0 1\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n"
                         "2 -6 3 0 0 0 0 0 0 0 0 0\n";
  ClipReport report;
  const auto clip = LoadClip(path, {}, &report);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  ExpectHips(*clip, {9.0f, 9.0f});
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("clip.bvh: the performer is far below the floor"),
            std::string::npos);
}

}  // namespace
}  // namespace furrow::motion
