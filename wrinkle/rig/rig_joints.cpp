// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_joints.h"

namespace furrow::wrinkle {

std::set<std::string> JointsOf(const Rig& rig) {
  std::set<std::string> joints = {rig.anchor};
  for (const ReferencePose& pose : rig.reference_poses) {
    for (const JointDelta& joint : pose.joints) joints.insert(joint.joint);
  }
  for (const Driver& driver : rig.drivers) {
    switch (driver.kind) {
      case Driver::Kind::kPose:
        for (const ControlPoint& point : driver.pose.points) joints.insert(point.joint);
        break;
      case Driver::Kind::kHinge:
        joints.insert({driver.hinge.parent, driver.hinge.joint, driver.hinge.end});
        break;
      case Driver::Kind::kBall:
        joints.insert({driver.ball.parent, driver.ball.joint, driver.ball.end});
        break;
      case Driver::Kind::kTwist:
        joints.insert(driver.twist.joint);
        joints.insert(driver.twist.through.begin(), driver.twist.through.end());
        break;
      case Driver::Kind::kStrain:
        joints.insert(driver.strain.joint);
        joints.insert(driver.strain.joints.begin(), driver.strain.joints.end());
        break;
      case Driver::Kind::kBlendShape: break;
    }
  }
  joints.erase("");
  return joints;
}

}  // namespace furrow::wrinkle
