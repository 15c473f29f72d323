// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "wrinkle/drivers/ball/ball_driver.h"
#include "wrinkle/drivers/blend_shape/blend_shape_driver.h"
#include "wrinkle/drivers/hinge/hinge_driver.h"
#include "wrinkle/drivers/influence_table.h"
#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/drivers/strain/strain_driver.h"
#include "wrinkle/drivers/twist/twist_driver.h"
#include "wrinkle/simd/lane_plan.h"
#include "wrinkle/simd/weight_plan.h"
#include "wrinkle/skeleton/joint_chain.h"
#include "wrinkle/solver/solver.h"
#include "wrinkle/weights/weight_table.h"

namespace furrow::wrinkle {

// A rig compiled for one skeleton, private to wrinkle/: contiguous arrays a driver kind, immutable,
// and nothing in it belongs to a subject.
struct BindingData {
  Rig rig;
  Skeleton skeleton;
  JointChains chains;
  PoseDriverSet pose_drivers;
  HingeDriverSet hinge_drivers;
  BallDriverSet ball_drivers;
  TwistDriverSet twist_drivers;
  BlendShapeDriverSet blend_shape_drivers;
  StrainDriverSet strain_drivers;
  WeightTable weights;
  InfluenceTable influences;
  std::vector<std::string> driver_value_names;
  std::vector<int> first_values;  // of the rig's drivers, and one past the last
  // How many values the first `num_drivers` of the rig's drivers have.
  [[nodiscard]] std::size_t NumValues(std::size_t num_drivers) const {
    return static_cast<std::size_t>(first_values[std::min(num_drivers, first_values.size() - 1)]);
  }
  // The same drivers and weights, laid out for the batch.
  LanePlan lanes;
  WeightPlan weight_plan;
  std::vector<std::string> missing_joints;
  std::vector<std::string> missing_blend_shapes;
  std::vector<std::string> warnings;
};

}  // namespace furrow::wrinkle
