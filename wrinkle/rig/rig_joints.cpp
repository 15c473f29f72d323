// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_joints.h"

#include <vector>

namespace furrow::wrinkle {

std::set<std::string> JointsOf(const Rig& rig) {
  std::set<std::string> joints = {rig.anchor};
  for (const ReferencePose& pose : rig.reference_poses) {
    for (const JointDelta& joint : pose.joints) joints.insert(joint.joint);
  }
  for (const Driver& driver : rig.drivers) {
    const std::vector<std::string> read =
        VisitFields(driver, [](const auto& fields) { return JointsRead(fields); });
    joints.insert(read.begin(), read.end());
  }
  joints.erase("");
  return joints;
}

}  // namespace furrow::wrinkle
