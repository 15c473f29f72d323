// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_joints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/solver/rig_binding.h"

namespace furrow::wrinkle {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Driver Brow(const std::string& name) {
  Driver driver;
  driver.name = name;
  driver.pose.points = {{.joint = "brow"}};
  driver.pose.values = {{"up", "up"}};
  return driver;
}

Rig BrowRig() {
  Rig rig;
  rig.reference_poses = {{.name = "up", .joints = {{.joint = "brow", .translation = {0, 1, 0}}}}};
  rig.drivers = {Brow("left"), Brow("right")};
  return rig;
}

TEST(RigJoints, AreThoseOfAnchorPosesAndDrivers) {
  Rig rig = BrowRig();
  EXPECT_THAT(JointsOf(rig), ElementsAre("brow"));
  rig.anchor = "head";
  rig.drivers[1].pose.anchor = "neck";
  EXPECT_THAT(JointsOf(rig), ElementsAre("brow", "head", "neck"));
}

TEST(RigJoints, PosesWithoutAnAnchorAreAWarning) {
  Rig rig = BrowRig();
  EXPECT_THAT(WarningOfModelSpace(rig),
              HasSubstr("driver 'left' and 1 more are measured in model"));
  const auto skeleton = Skeleton::Create({{"head", -1, {}, {}}, {"brow", 0, {{0, 1, 0}}, {}}});
  const auto binding = RigBinding::Create(rig, *skeleton, {});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_THAT(binding->warnings(), Contains(HasSubstr("measured in model space")));
  rig.drivers[0].pose.anchor = "head";
  EXPECT_THAT(WarningOfModelSpace(rig), HasSubstr("driver 'right' is measured in model space"));
  rig.anchor = "head";
  EXPECT_THAT(WarningOfModelSpace(rig), IsEmpty());
  rig.anchor.clear();
  for (Driver& driver : rig.drivers) driver.kind = Driver::Kind::kTwist;
  EXPECT_THAT(WarningOfModelSpace(rig), IsEmpty());
}

}  // namespace
}  // namespace furrow::wrinkle
