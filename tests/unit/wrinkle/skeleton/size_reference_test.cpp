// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/size_reference.h"

#include <gtest/gtest.h>

#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

// A head with four points of a face, 0.1 apart, on a neck of 0.2. `scale` is the unit.
Skeleton Head(float scale, bool with_hand) {
  const auto at = [scale](float x, float y) {
    Transform local;
    local.translation = {scale * x, scale * y, 0.0f};
    return local;
  };
  std::vector<JointDesc> joints = {
      {"neck", kNoJoint, at(0.0f, 1.5f)}, {"head", 0, at(0.0f, 0.2f)},
      {"brow_l", 1, at(0.05f, 0.1f)},     {"brow_r", 1, at(-0.05f, 0.1f)},
      {"lip_l", 1, at(0.05f, 0.0f)},      {"lip_r", 1, at(-0.05f, 0.0f)}};
  if (with_hand) joints.push_back({"hand", 0, at(0.8f, 0.0f)});
  return *Skeleton::Create(std::move(joints));
}

const std::set<std::string> kFace = {"head", "brow_l", "brow_r", "lip_l", "lip_r"};

TEST(SizeReference, DoesNotDependOnOtherJoints) {
  const Skeleton whole = Head(1.0f, true);
  const SizeReference reference = MakeSizeReference(whole, kFace);
  EXPECT_EQ(reference.joints.size(), 5u);
  EXPECT_FLOAT_EQ(reference.size, SkeletonSize(whole));
  EXPECT_NEAR(SkeletonSizeBy(&reference, whole), SkeletonSize(whole), 1e-6f);
  EXPECT_NEAR(SkeletonSizeBy(&reference, Head(1.0f, false)), SkeletonSize(whole), 1e-6f);
  EXPECT_NEAR(SkeletonSizeBy(&reference, Head(100.0f, false)), 100.0f * SkeletonSize(whole), 1e-4f);
}

TEST(SizeReference, IsTheSumOfBonesWhereItSaysNothing) {
  const Skeleton skeleton = Head(1.0f, false);
  EXPECT_EQ(SkeletonSizeBy(nullptr, skeleton), SkeletonSize(skeleton));
  // Three shared joints of five: too few.
  SizeReference other = MakeSizeReference(Head(2.0f, true), kFace);
  other.joints[3].name = "a";
  other.joints[4].name = "b";
  EXPECT_EQ(SkeletonSizeBy(&other, skeleton), SkeletonSize(skeleton));
  SizeReference in_one_place = MakeSizeReference(Head(2.0f, true), kFace);
  for (auto& joint : in_one_place.joints) joint.position = glm::vec3(1.0f);
  EXPECT_EQ(SkeletonSizeBy(&in_one_place, skeleton), SkeletonSize(skeleton));
}

TEST(SizeReference, OfTwoJointsNeedsBoth) {
  const Skeleton skeleton = Head(0.5f, false);
  SizeReference reference = MakeSizeReference(Head(1.0f, true), {"neck", "head"});
  EXPECT_NEAR(SkeletonSizeBy(&reference, skeleton), 0.5f * reference.size, 1e-6f);
  reference.joints[1].name = "skull";
  EXPECT_EQ(SkeletonSizeBy(&reference, skeleton), SkeletonSize(skeleton));
}

}  // namespace
}  // namespace furrow::wrinkle
