// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#define FURROW_BOUND_DRIVERS
#include "wrinkle/drivers/driver_kinds.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/point_plan.h"
#include "wrinkle/simd/row_gather.h"
#include "wrinkle/skeleton/joint_chain.h"
#include "wrinkle/weights/influence_table.h"
#include "wrinkle/weights/weight_plan.h"
#include "wrinkle/weights/weight_table.h"

namespace furrow::wrinkle {

// The bound drivers of each kind: `pose` is a PoseDriverSet, `hinge` a HingeDriverSet, and so on.
struct BoundDrivers {
#define FURROW_KIND_SET(Name, field) Name##DriverSet field;
  FURROW_DRIVER_KINDS(FURROW_KIND_SET)
#undef FURROW_KIND_SET
};

// Calls `visit` with the driver set of each kind.
template <class Drivers, class Visitor>
void VisitDriverSets(Drivers& drivers, Visitor visit) {
#define FURROW_KIND_VISIT(Name, field) visit(drivers.field);
  FURROW_DRIVER_KINDS(FURROW_KIND_VISIT)
#undef FURROW_KIND_VISIT
}

// A rig compiled for one skeleton: immutable, and without anything that belongs to a subject.
// Private to wrinkle/.
struct BindingData {
  Rig rig;
  Skeleton skeleton;
  JointChains chains;
  BoundDrivers drivers;
  WeightTable weights;
  InfluenceTable influences;
  std::vector<std::string> driver_value_names;
  std::vector<int> first_values;  // of the rig's drivers, and one past the last
  // How many values the first `num_drivers` of the rig's drivers have.
  [[nodiscard]] std::size_t NumValues(std::size_t num_drivers) const {
    return static_cast<std::size_t>(first_values[std::min(num_drivers, first_values.size() - 1)]);
  }
  // The layout for the kernel.
  PointPlan points;
  RowGather values;                  // brings driver values from the scratch memory into rig order
  std::uint32_t num_value_rows = 1;  // rows of the scratch memory that drivers use
  WeightPlan weight_plan;

  std::vector<std::string> missing_joints;
  std::vector<std::string> missing_blend_shapes;
  std::vector<std::string> warnings;
};

}  // namespace furrow::wrinkle
