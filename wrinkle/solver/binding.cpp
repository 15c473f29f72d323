// SPDX-License-Identifier: Apache-2.0
#include <unordered_map>
#include <utility>

#include "base/status.h"
#include "wrinkle/drivers/bind_context.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/rig_check.h"
#include "wrinkle/solver/binding_data.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {
namespace {

Status BindDriver(const Driver& driver, int first_value, BindContext* context, BindingData* data) {
  switch (driver.kind) {
    case Driver::Kind::kPose: return data->pose_drivers.Bind(driver, first_value, context);
    case Driver::Kind::kHinge: return data->hinge_drivers.Bind(driver, first_value, context);
    case Driver::Kind::kBall: return data->ball_drivers.Bind(driver, first_value, context);
    case Driver::Kind::kTwist: return data->twist_drivers.Bind(driver, first_value, context);
    case Driver::Kind::kBlendShape:
      return data->blend_shape_drivers.Bind(driver, first_value, context);
    case Driver::Kind::kStrain: return data->strain_drivers.Bind(driver, first_value, context);
  }
  return {StatusCode::kInvalidArgument, "driver '" + driver.name + "' is of no known kind"};
}

}  // namespace

Result<RigBinding> RigBinding::Create(const Rig& rig, const Skeleton& skeleton,
                                      std::span<const std::string> blend_shape_names,
                                      const BindOptions& options) {
  FURROW_RETURN_IF_ERROR(CheckRigFields(rig));
  auto data = std::make_unique<BindingData>();
  data->rig = rig;
  data->skeleton = skeleton;
  BindContext context(rig, skeleton, blend_shape_names, options, &data->chains);
  FURROW_RETURN_IF_ERROR(context.ResolveAnchorAndPoses());

  std::unordered_map<std::string, int> value_index;
  for (const Driver& driver : rig.drivers) {
    const int first_value = static_cast<int>(data->driver_value_names.size());
    data->first_values.push_back(first_value);
    FURROW_RETURN_IF_ERROR(BindDriver(driver, first_value, &context, data.get()));
    for (const std::string& value : DriverValueNames(driver)) {
      std::string name = driver.name + "." + value;
      value_index.emplace(name, static_cast<int>(data->driver_value_names.size()));
      data->driver_value_names.push_back(std::move(name));
    }
  }
  data->first_values.push_back(static_cast<int>(data->driver_value_names.size()));
  FURROW_RETURN_IF_ERROR(data->weights.Bind(rig, value_index));
  data->influences.Bind(rig, skeleton, value_index);
  data->lanes = MakeLanePlan(*data);
  data->weight_plan = MakeWeightPlan(data->weights);
  data->missing_joints = std::move(context.missing_joints());
  data->missing_blend_shapes = std::move(context.missing_blend_shapes());
  data->warnings = std::move(context.warnings());
  return RigBinding(std::move(data));
}

RigBinding::RigBinding(std::unique_ptr<BindingData> data) : data_(std::move(data)) {}
RigBinding::RigBinding(RigBinding&&) noexcept = default;
RigBinding& RigBinding::operator=(RigBinding&&) noexcept = default;
RigBinding::~RigBinding() = default;

std::span<const std::string> RigBinding::weight_names() const { return data_->weights.names(); }
std::span<const DynamicMask> RigBinding::dynamic_masks() const { return data_->influences.masks(); }
std::span<const std::string> RigBinding::driver_value_names() const {
  return data_->driver_value_names;
}
std::span<const std::string> RigBinding::missing_joints() const { return data_->missing_joints; }
std::span<const std::string> RigBinding::missing_blend_shapes() const {
  return data_->missing_blend_shapes;
}
std::span<const std::string> RigBinding::warnings() const { return data_->warnings; }
const Skeleton& RigBinding::skeleton() const { return data_->skeleton; }
const Rig& RigBinding::rig() const { return data_->rig; }

}  // namespace furrow::wrinkle
