// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/face_frame.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;

TEST(FaceFrame, HairAndHatsAreNotJointsOfTheFace) {
  std::vector<wrinkle::JointDesc> joints;
  const auto add = [&](const char* name, int parent) {
    wrinkle::JointDesc joint;
    joint.name = name;
    joint.parent = parent;
    joints.push_back(std::move(joint));
  };
  add("Head", wrinkle::kNoJoint);
  add("J_Sec_Hair1_01", 0);
  add("J_Sec_02", 1);  // hangs from hair
  add("brow_l", 0);
  add("PonyTail", 0);
  add("GlassesRoot", 0);
  add("eye_l", 0);
  add("lip_upper", 3);
  const auto skeleton = wrinkle::Skeleton::Create(joints);
  ASSERT_TRUE(skeleton.ok());
  FoundJoints found;
  found.roles.assign(joints.size(), wrinkle::JointRole::kNone);
  found.roles[0] = wrinkle::JointRole::kHead;
  found.roles[6] = wrinkle::JointRole::kLeftEye;
  EXPECT_THAT(FaceJoints(*skeleton, found), ElementsAre(3, 7));
}

TEST(FaceFrame, AdornmentsAreNamedInAnyCase) {
  EXPECT_TRUE(IsAdornment("HAIR_back"));
  EXPECT_TRUE(IsAdornment("Skirt.001"));
  EXPECT_FALSE(IsAdornment("risorius_l"));
  EXPECT_FALSE(IsAdornment("zygomaticus_r"));
}

}  // namespace
}  // namespace furrow::authoring
