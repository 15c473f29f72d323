// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/animated_subject.h"

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "motion/livelink/livelink_csv.h"

namespace furrow::cli {
namespace {

// A head with one joint for the jaw, a pose that opens the jaw by that joint, and a triangle.
character::Character Face() {
  character::Character face;
  wrinkle::JointDesc head{.name = "head", .parent = wrinkle::kNoJoint, .rest = {}, .tail = {}};
  wrinkle::JointDesc jaw{.name = "jaw", .parent = 0, .rest = {}, .tail = {}};
  face.skeleton = wrinkle::Skeleton::Create({head, jaw}).value();
  face.inverse_bind_matrices.resize(2, glm::mat4(1.0f));
  wrinkle::ReferencePose open{.name = "jawOpen", .joints = {}};
  open.joints.push_back({.joint = "jaw", .translation = glm::vec3(0.0f, -0.02f, 0.0f)});
  face.rig.reference_poses = {open};
  return face;
}

std::shared_ptr<const motion::Clip> Recording() {
  const std::string text =
      "Timecode,BlendShapeCount,JawOpen,BrowInnerUp,HeadYaw\n"
      "00:00:00:00.000,3,0,0,0\n"
      "00:00:00:01.000,3,0.5,0.25,0\n";
  auto clip = motion::ParseLiveLinkCsv(text, "take.csv");
  EXPECT_TRUE(clip.ok()) << clip.status().ToString();
  return std::make_shared<const motion::Clip>(std::move(*clip));
}

std::unique_ptr<AnimatedSubject> Animate(const character::Character& face) {
  auto subject = AnimatedSubject::Create(face, Recording(), rig::SkeletonMatcher(),
                                         rig::ShapeMatcher(), "take.csv");
  EXPECT_TRUE(subject.ok()) << subject.status().ToString();
  return std::move(*subject);
}

TEST(AnimatedSubject, ALiveLinkFaceRecordingGivesTheWeightsOfTheShapes) {
  character::Character face = Face();
  face.shapes = {"browInnerUp", "cheekPuff", "jawOpen"};
  const auto subject = Animate(face);
  ASSERT_TRUE(subject->Advance(0).ok());
  const glm::mat4 closed = subject->subject().model[1];
  ASSERT_TRUE(subject->Advance(1).ok());
  const auto shapes = subject->subject().shapes;
  EXPECT_EQ(std::vector<float>(shapes.begin(), shapes.end()),
            (std::vector<float>{0.25f, 0.0f, 0.5f}));
  EXPECT_EQ(subject->subject().model[1], closed) << "the shape jawOpen opens the mouth alone";
}

// The drawn face has the limits of MatchFace(): here its mouthClose opens the jaw itself, and its
// lids fade.
TEST(AnimatedSubject, TheDrawnFaceKeepsItsLimits) {
  character::Character face = Face();
  face.shapes = {"jawOpen", "mouthClose", "eyeSquintLeft", "eyeBlinkLeft"};
  face.shape_rules = {{.shape = 1, .contains = 0}};
  auto clip = motion::ParseLiveLinkCsv(
      "Timecode,BlendShapeCount,JawOpen,MouthClose,EyeSquintLeft,EyeBlinkLeft\n"
      "00:00:00:00.000,4,0.75,0.25,1,0.5\n",
      "take.csv");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const auto subject =
      AnimatedSubject::Create(face, std::make_shared<const motion::Clip>(std::move(*clip)),
                              rig::SkeletonMatcher(), rig::ShapeMatcher(), "take.csv");
  ASSERT_TRUE(subject.ok()) << subject.status().ToString();
  ASSERT_TRUE((*subject)->Advance(0).ok());
  const auto shapes = (*subject)->subject().shapes;
  EXPECT_EQ(std::vector<float>(shapes.begin(), shapes.end()),
            (std::vector<float>{0.5f, 0.25f, 0.6f, 0.5f}));
}

TEST(AnimatedSubject, WithoutShapesTheJointsMove) {
  const character::Character face = Face();
  const auto subject = Animate(face);
  ASSERT_TRUE(subject->Advance(1).ok());
  EXPECT_TRUE(subject->subject().shapes.empty());
  EXPECT_NEAR(subject->subject().model[1][3].y, -0.01f, 1e-6f);
}

}  // namespace
}  // namespace furrow::cli
