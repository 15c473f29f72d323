// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "wrinkle/drivers/common/bind_context.h"
#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/drivers/twist/twist_fields.h"
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// One joint per lane of a block's drivers.
struct TwistStep {
  JointStep joint;
  FloatRow rest_inverse[4];  // x, y, z, w
  FloatRow axis[3];
};

struct TwistBlock : Block {
  std::uint32_t first_step = 0;  // into TwistDriverSet::steps()
  std::uint32_t num_steps = 0;   // of the driver with the most joints
  FloatRow inverse_full;
};

// All twist drivers of a binding. Private to wrinkle/. twist_lanes-inl.h evaluates them.
class TwistDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int first_joint = 0;  // into joints_
    int num_joints = 0;
    float inverse_full = 0.0f;  // 1 / (angle of a full twist in radians)
  };
  struct TwistJoint {
    int joint = kNoJoint;
    glm::quat rest_inverse{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 axis{0.0f};  // unit, joint's axes
  };

  [[nodiscard]] Status Bind(const std::string& name, const TwistDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the summed twist angle of each driver.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] std::span<const TwistJoint> joints(const Entry& entry) const {
    return std::span(joints_).subspan(static_cast<std::size_t>(entry.first_joint),
                                      static_cast<std::size_t>(entry.num_joints));
  }
  [[nodiscard]] const std::vector<TwistBlock>& blocks() const { return blocks_; }
  [[nodiscard]] const std::vector<TwistStep>& steps() const { return steps_; }

 private:
  void PlanStep(const Lanes& lanes, std::size_t index);

  std::vector<Entry> entries_;
  std::vector<TwistJoint> joints_;
  std::vector<TwistBlock> blocks_;
  std::vector<TwistStep> steps_;
};

}  // namespace furrow::wrinkle
