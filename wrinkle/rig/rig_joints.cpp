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

std::string WarningOfModelSpace(const Rig& rig) {
  const std::string* first = nullptr;
  int more = -1;
  for (const Driver& driver : rig.drivers) {
    const bool has_anchor = !rig.anchor.empty() || !driver.pose.anchor.empty();
    if (driver.kind != Driver::Kind::kPose || has_anchor) continue;
    if (JointsRead(driver.pose).empty()) continue;  // it measures blend shapes alone
    if (first == nullptr) first = &driver.name;
    ++more;
  }
  if (first == nullptr) return {};
  const std::string others = more == 0 ? " is" : " and " + std::to_string(more) + " more are";
  return "driver '" + *first + "'" + others +
         " measured in model space, so every move of the body changes the values; name an anchor "
         "in the rig or in the driver, such as the head for a face";
}

}  // namespace furrow::wrinkle
