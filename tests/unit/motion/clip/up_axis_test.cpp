// SPDX-License-Identifier: Apache-2.0
#include "motion/clip/up_axis.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/motion/clip/offset_joint.h"

namespace furrow::motion {
namespace {

Clip Standing(const char* top, const glm::vec3& up) {
  Clip clip;
  clip.skeleton = *wrinkle::Skeleton::Create(
      {OffsetJoint("Hips", -1, up), OffsetJoint("Spine", 0, up), OffsetJoint(top, 1, up)});
  return clip;
}

TEST(UpAxis, IsInferredFromTheHead) {
  EXPECT_EQ(FindUpAxis(Standing("Head", {0, 1, 0}).skeleton), UpAxis::kY);
  EXPECT_EQ(FindUpAxis(Standing("head", {0, 0, 1}).skeleton), UpAxis::kZ);
  EXPECT_EQ(FindUpAxis(Standing("mixamorig:Head", {0, 0.2f, 1}).skeleton), UpAxis::kZ);
  EXPECT_EQ(FindUpAxis(Standing("Head", {0, 0, -1}).skeleton), UpAxis::kY);    // upside down
  EXPECT_EQ(FindUpAxis(Standing("Tail", {0, 0, 1}).skeleton), UpAxis::kAuto);  // no head
  EXPECT_EQ(FindUpAxis(wrinkle::Skeleton()), UpAxis::kAuto);
}

// A body on two or four legs, whose joints have numbers instead of names. `turn`: of the whole.
Clip OnLegs(bool fox, const char* top, const glm::quat& turn) {
  Clip clip;
  const glm::vec3 trunk = fox ? glm::vec3(0, 0, 0.3f) : glm::vec3(0, 0.25f, 0);
  std::vector<wrinkle::JointDesc> joints = {
      OffsetJoint("j0", -1, turn * glm::vec3(0, fox ? 0.5f : 1.0f, 0)),
      OffsetJoint("j1", 0, turn * trunk), OffsetJoint("j2", 1, turn * trunk),
      OffsetJoint(top, 2, turn * glm::vec3(0, 0.1f, fox ? 0.2f : 0.0f))};
  const auto limb = [&](int parent, glm::vec3 start, glm::vec3 bone) {
    for (int i = 0; i < 3; ++i) {
      const std::string name = "j" + std::to_string(joints.size());
      joints.push_back(OffsetJoint(name.c_str(),
                                   i == 0 ? parent : static_cast<int>(joints.size()) - 1,
                                   turn * (i == 0 ? start : bone)));
    }
  };
  for (const float side : {0.1f, -0.1f}) {
    limb(0, {side, 0, 0}, {0, fox ? -0.25f : -0.45f, 0});
    limb(2, {side, 0, 0}, fox ? glm::vec3(0, -0.25f, 0) : glm::vec3(3.0f * side, 0, 0));
  }
  clip.skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  const auto rest = clip.skeleton.rest_pose();
  for (int frame = 0; frame < 10; ++frame) {
    clip.times.push_back(0.1 * frame);
    clip.locals.insert(clip.locals.end(), rest.begin(), rest.end());
  }
  return clip;
}

const glm::quat kNoTurn(1, 0, 0, 0);
const glm::quat kToZUp = glm::angleAxis(glm::radians(90.0f), glm::vec3(1, 0, 0));

TEST(UpAxis, IsAwayFromTheFeetWhateverTheNames) {
  EXPECT_EQ(FindUpAxis(OnLegs(false, "j3", kNoTurn).skeleton), UpAxis::kY);
  EXPECT_EQ(FindUpAxis(OnLegs(false, "j3", kToZUp).skeleton), UpAxis::kZ);
  EXPECT_EQ(FindUpAxis(OnLegs(false, "Head", kToZUp).skeleton), UpAxis::kZ);
  EXPECT_EQ(FindUpAxis(OnLegs(true, "j3", kNoTurn).skeleton), UpAxis::kY);
  EXPECT_EQ(FindUpAxis(OnLegs(true, "j3", kToZUp).skeleton), UpAxis::kZ);
}

// The head of a fox is ahead of its root, along Z.
TEST(UpAxis, AFoxIsNotStoodUpright) {
  const Clip fox = OnLegs(true, "Head", kNoTurn);
  EXPECT_EQ(FindUpAxis(fox.skeleton), UpAxis::kY);
  Clip on_the_spot = fox;
  for (std::size_t i = 0; i < on_the_spot.locals.size(); i += fox.locals.size() / 10)
    on_the_spot.locals[i].translation = {0, 0.5f, 0};
  EXPECT_FALSE(MovesAlongZ(on_the_spot));
}

TEST(UpAxis, LongSkeletonsMayBeZUp) {
  EXPECT_TRUE(IsLongestAlongZ(Standing("Tail", {0, 0, 1}).skeleton));
  EXPECT_FALSE(IsLongestAlongZ(Standing("Tail", {0, 1, 0.5f}).skeleton));
  EXPECT_FALSE(IsLongestAlongZ(wrinkle::Skeleton()));
}

// In every pose, all model-space positions turn about the same axis.
TEST(UpAxis, TurningAClipTurnsItsPoses) {
  Clip clip = Standing("Head", {0.1f, 0.2f, 1});
  clip.times = {0.0};
  clip.locals.assign(clip.skeleton.rest_pose().begin(), clip.skeleton.rest_pose().end());
  clip.locals[0].rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  clip.locals[1].rotation = glm::angleAxis(-1.1f, glm::normalize(glm::vec3(-2, 1, 0.5f)));
  clip.locals[1].scale = {1, 2, 3};
  std::vector<glm::mat4> before(3), after(3);
  ASSERT_EQ((wrinkle::LocalToModelJob{&clip.skeleton, clip.locals, before}).Run(),
            wrinkle::JobStatus::kOk);
  ASSERT_TRUE(TurnZUpToYUp(&clip).ok());
  ASSERT_EQ((wrinkle::LocalToModelJob{&clip.skeleton, clip.locals, after}).Run(),
            wrinkle::JobStatus::kOk);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(clip.skeleton.rest_pose()[j].rotation, glm::quat(1, 0, 0, 0));
    EXPECT_NEAR(after[j][3].x, before[j][3].x, 1e-5f);
    EXPECT_NEAR(after[j][3].y, before[j][3].z, 1e-5f);
    EXPECT_NEAR(after[j][3].z, -before[j][3].y, 1e-5f);
  }
  EXPECT_EQ(FindUpAxis(clip.skeleton), UpAxis::kY);
}

// A body that walks in some direction on a floor of height 0, with a turn of the whole about X.
Clip Walking(float degrees, const glm::vec3& floor_axis, float height) {
  Clip clip;
  clip.skeleton = *wrinkle::Skeleton::Create({OffsetJoint("Hips", -1, {0, 1, 0}),
                                              OffsetJoint("Head", 0, {0, 0.6f, 0}),
                                              OffsetJoint("Foot", 0, {0, -1, 0})});
  const glm::quat turn = glm::angleAxis(glm::radians(degrees), glm::vec3(1, 0, 0));
  for (int frame = 0; frame < 30; ++frame) {
    clip.times.push_back(0.1 * frame);
    const auto rest = clip.skeleton.rest_pose();
    clip.locals.insert(clip.locals.end(), rest.begin(), rest.end());
    wrinkle::Transform& root = clip.locals[clip.locals.size() - 3];
    root.rotation = turn * glm::angleAxis(0.2f * static_cast<float>(frame), glm::vec3(0, 1, 0));
    root.translation =
        0.1f * static_cast<float>(frame) * floor_axis + height * (turn * glm::vec3(0, 1, 0));
  }
  return clip;
}

TEST(UpAxis, MotionAlongZIsTold) {
  EXPECT_TRUE(MovesAlongZ(Walking(90.0f, {0, 1, 0}, 1.0f)));
  EXPECT_TRUE(MovesAlongZ(Walking(80.0f, {0.1f, 0, 0}, 1.0f)));  // leans
  EXPECT_FALSE(MovesAlongZ(Walking(0.0f, {0, 0, 1}, 1.0f)));     // upright
  EXPECT_FALSE(MovesAlongZ(Walking(-90.0f, {0, 1, 0}, 1.0f)));   // the head points to -Z
  // Somebody who crawls on his back does not keep his feet at z = 0.
  EXPECT_FALSE(MovesAlongZ(Walking(90.0f, {0, 0, 1}, 0.0f)));
  EXPECT_FALSE(MovesAlongZ(Clip()));
  Clip nobody = Walking(90.0f, {0, 1, 0}, 1.0f);
  nobody.skeleton = *wrinkle::Skeleton::Create({OffsetJoint("a", -1, {0, 1, 0}),
                                                OffsetJoint("b", 0, {0, 0.6f, 0}),
                                                OffsetJoint("c", 0, {0, -1, 0})});
  EXPECT_FALSE(MovesAlongZ(nobody));
}

TEST(UpAxis, MotionAlongZIsTurnedOverItsRestPose) {
  Clip clip = Walking(90.0f, {0, -1, 0}, 1.0f);
  const Clip upright = Walking(0.0f, {0, 0, 1}, 1.0f);
  TurnMotionUpright(&clip);
  ASSERT_EQ(clip.locals.size(), upright.locals.size());
  for (std::size_t i = 0; i < clip.locals.size(); ++i) {
    EXPECT_LT(glm::length(clip.locals[i].translation - upright.locals[i].translation), 1e-5f);
    EXPECT_GT(std::abs(glm::dot(clip.locals[i].rotation, upright.locals[i].rotation)), 0.999999f);
  }
}

// Without names, the body is still turned upright; without legs, a warning names the way out.
TEST(UpAxis, LoadClipTurnsBodiesWithoutAHeadOrSaysThatItCannot) {
  const TemporaryFolder folder;
  const auto path = (folder / "clip.bvh").string();
  const Clip lying = OnLegs(false, "j3", kToZUp);
  ASSERT_TRUE(SaveClip(lying, path).ok());
  ClipReport report;
  const auto turned = LoadClip(path, {}, &report);
  ASSERT_TRUE(turned.ok()) << turned.status().ToString();
  EXPECT_TRUE(report.warnings.empty());
  const Clip upright = OnLegs(false, "j3", kNoTurn);
  ASSERT_EQ(turned->skeleton.num_joints(), upright.skeleton.num_joints());
  for (int j = 0; j < upright.skeleton.num_joints(); ++j) {
    const int own =
        turned->skeleton.Find(upright.skeleton.joint_names()[static_cast<std::size_t>(j)]);
    EXPECT_LT(glm::distance(wrinkle::RestOrigin(turned->skeleton, own),
                            wrinkle::RestOrigin(upright.skeleton, j)),
              1e-4f)
        << j;
  }

  Clip tail = Standing("Tail", {0, 0, 1});
  tail.times = {0.0};
  tail.locals.assign(tail.skeleton.rest_pose().begin(), tail.skeleton.rest_pose().end());
  ASSERT_TRUE(SaveClip(tail, path).ok());
  const auto kept = LoadClip(path, {}, &report);
  ASSERT_TRUE(kept.ok()) << kept.status().ToString();
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("the axis that points up is unknown"), std::string::npos);
  EXPECT_NE(report.warnings[0].find("--up-axis z"), std::string::npos);
  report.warnings.clear();
  ASSERT_TRUE(LoadClip(path, {.up_axis = UpAxis::kY}, &report).ok());
  EXPECT_TRUE(report.warnings.empty());
}

std::string Bvh(const char* offset, const char* positions) {
  return std::string("HIERARCHY\nROOT Hips\n{\nOFFSET ") + offset +
         "\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
         "JOINT Head\n{\nOFFSET 0 0 2\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
         "End Site\n{\nOFFSET 0 0 1\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n" +
         positions + " 0 0 0 0 0 0\n" + positions + " 0 0 0 0 0 0\n";
}

TEST(UpAxis, LoadClipTurnsBvhUprightAndKeepsUnmovedRootsAtRest) {
  const TemporaryFolder folder;
  const auto path = folder / "clip.bvh";
  const auto load = [&path](const std::string& text, UpAxis up) {
    std::ofstream(path) << text;
    LoadOptions options;
    options.up_axis = up;
    Result<Clip> clip = LoadClip(path, options);
    EXPECT_TRUE(clip.ok()) << clip.status().ToString();
    return clip.ok() ? std::move(*clip) : Clip();
  };
  const Clip unmoved = load(Bvh("1 2 3", "0 0 0"), UpAxis::kAuto);
  ASSERT_EQ(unmoved.locals.size(), 4u);
  EXPECT_EQ(unmoved.skeleton.rest_pose()[1].translation, glm::vec3(0, 2, 0));
  EXPECT_EQ(unmoved.locals[2].translation, glm::vec3(1, 3, -2));
  const Clip moved = load(Bvh("1 2 3", "0 0 5"), UpAxis::kAuto);
  ASSERT_EQ(moved.locals.size(), 4u);
  EXPECT_EQ(moved.locals[2].translation, glm::vec3(0, 5, 0));
  const Clip as_it_is = load(Bvh("1 2 3", "0 0 5"), UpAxis::kY);
  ASSERT_EQ(as_it_is.locals.size(), 4u);
  EXPECT_EQ(as_it_is.locals[2].translation, glm::vec3(0, 0, 5));
}

TEST(UpAxis, LoadClipTurnsMotionAlongZAndSaysSo) {
  const TemporaryFolder folder;
  const auto path = folder / "clip.bvh";
  std::ofstream(path) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 9 0\n"
                         "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
                         "JOINT Head\n{\nOFFSET 0 6 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                         "End Site\n{\nOFFSET 0 1 0\n}\n}\n"
                         "JOINT Foot\n{\nOFFSET 0 -9 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                         "End Site\n{\nOFFSET 0 0 1\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n"
                         "3 4 9 0 0 90 0 0 0 0 0 0\n3 5 9 0 0 90 0 0 0 0 0 0\n";
  ClipReport report;
  const auto turned = LoadClip(path, {}, &report);
  ASSERT_TRUE(turned.ok()) << turned.status().ToString();
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("clip.bvh: the rest pose stands along Y"), std::string::npos);
  EXPECT_LT(glm::length(turned->locals[3].translation - glm::vec3(3, 9, -5)), 1e-5f);
  EXPECT_GT(turned->locals[3].rotation.w, 0.9999f);
  LoadOptions options;
  options.up_axis = UpAxis::kY;
  const auto kept = LoadClip(path, options, nullptr);
  ASSERT_TRUE(kept.ok());
  EXPECT_EQ(kept->locals[3].translation, glm::vec3(3, 5, 9));
}

}  // namespace
}  // namespace furrow::motion
