// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/neutral_part.h"

#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using wrinkle::JointRole;

// A body with a face: 0 hips, 1 arm, 2 head, 3 brow, 4 tip of the brow, 5 eye.
StreamDefinition BodyWithFace() {
  StreamDefinition stream;
  auto skeleton = wrinkle::Skeleton::Create({{"hips", -1, {}, {}},
                                             {"arm", 0, {}, {}},
                                             {"head", 0, {}, {}},
                                             {"brow", 2, {}, {}},
                                             {"brow_tip", 3, {}, {}},
                                             {"eye", 2, {}, {}}});
  stream.skeleton = *std::move(skeleton);
  stream.blend_shapes = {"jawOpen"};
  stream.match.stream.roles = {JointRole::kHips, JointRole::kLeftUpperArm, JointRole::kHead,
                               JointRole::kNone, JointRole::kNone,         JointRole::kLeftEye};
  return stream;
}

// All joints and the blend shape away from rest.
wrinkle::LocalPose Moved(float by) {
  wrinkle::LocalPose pose;
  pose.joints.resize(6);
  for (wrinkle::Transform& joint : pose.joints) joint.translation = glm::vec3(by);
  pose.blend_shapes = {by};
  return pose;
}

std::vector<float> Places(const wrinkle::LocalPose& pose) {
  std::vector<float> places;
  for (const wrinkle::Transform& joint : pose.joints) places.push_back(joint.translation.x);
  places.push_back(pose.blend_shapes.at(0));
  return places;
}

TEST(NeutralPart, CapturesItsJointsAndKeepsTheOthers) {
  const StreamDefinition stream = BodyWithFace();
  const auto capture = [&](NeutralPart part, const std::optional<wrinkle::LocalPose>& former) {
    return Places(CaptureNeutralPart(part, stream, Moved(1.0f), former));
  };
  using Floats = std::vector<float>;
  EXPECT_EQ(capture(NeutralPart::kFace, {}), (Floats{0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(capture(NeutralPart::kBody, {}), (Floats{1, 1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(capture(NeutralPart::kBoth, {}), (Floats{1, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(capture(NeutralPart::kFace, Moved(2.0f)), (Floats{2, 2, 2, 1, 1, 1, 1}));
  EXPECT_EQ(capture(NeutralPart::kBody, Moved(2.0f)), (Floats{1, 1, 1, 2, 2, 2, 2}));
}

TEST(NeutralPart, DefaultsToTheFaceOfStreamsThatHaveOne) {
  StreamDefinition stream = BodyWithFace();
  EXPECT_EQ(DefaultNeutralPart(stream), NeutralPart::kFace);
  stream.blend_shapes.clear();
  EXPECT_EQ(DefaultNeutralPart(stream), NeutralPart::kFace) << "joints below the head";
  stream.match.stream.roles.clear();
  EXPECT_EQ(DefaultNeutralPart(stream), NeutralPart::kBoth) << "nothing is known to be a face";
  stream.blend_shapes = {"jawOpen"};
  EXPECT_EQ(DefaultNeutralPart(stream), NeutralPart::kFace);
}

TEST(NeutralPart, NamesAreReadBack) {
  for (const NeutralPart part : {NeutralPart::kFace, NeutralPart::kBody, NeutralPart::kBoth}) {
    EXPECT_EQ(ParseNeutralPart(ToString(part)), part);
  }
  EXPECT_FALSE(ParseNeutralPart("arms"));
  EXPECT_FALSE(ParseNeutralPart(""));
}

}  // namespace
}  // namespace furrow::server
