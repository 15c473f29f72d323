// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/rig_binding.h"

#include <type_traits>
#include <unordered_map>
#include <utility>

#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/rig_check.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {
namespace {

// What drivers of this rig need: the rig's anchor only if a driver of joints without its own
// measures from it, joints only if a driver reads them. Streams of blend shapes alone thus bind to
// rigs without joints.
BindSource SourceOf(const Rig& rig, std::span<const std::string> blend_shape_names) {
  BindSource source{.size_reference = rig.size_reference.get(),
                    .reference_poses = rig.reference_poses,
                    .blend_shape_names = blend_shape_names};
  for (const Driver& driver : rig.drivers) {
    VisitFields(driver, [&](const auto& fields) {
      if (JointsRead(fields).empty()) return;
      source.reads_joints = true;
      if constexpr (std::decay_t<decltype(fields)>::kMeasuresFromAnchor) {
        if (fields.anchor.empty()) source.anchor = rig.anchor;
      }
    });
  }
  return source;
}

Status BindDriver(const Driver& driver, int first_value, BindContext* context,
                  BoundDrivers* drivers) {
  switch (driver.kind) {
#define FURROW_KIND_BIND(Name, field) \
  case Driver::Kind::k##Name:         \
    return drivers->field.Bind(driver.name, driver.field, first_value, context);
    FURROW_DRIVER_KINDS(FURROW_KIND_BIND)
#undef FURROW_KIND_BIND
  }
  return {StatusCode::kInvalidArgument, "driver '" + driver.name + "' has an unknown kind"};
}

using ValueIndex = std::unordered_map<std::string, int>;

// The values of a driver are neighbours in the list of values, in the order of the rig.
// `first_values` ends with the total.
Status BindDrivers(const Rig& rig, BindContext* context, BindingData* data, ValueIndex* index) {
  for (const Driver& driver : rig.drivers) {
    const int first_value = static_cast<int>(data->driver_value_names.size());
    data->first_values.push_back(first_value);
    FURROW_RETURN_IF_ERROR(BindDriver(driver, first_value, context, &data->drivers));
    for (const std::string& value : DriverValueNames(driver)) {
      std::string name = driver.name + "." + value;
      index->emplace(name, static_cast<int>(data->driver_value_names.size()));
      data->driver_value_names.push_back(std::move(name));
    }
  }
  data->first_values.push_back(static_cast<int>(data->driver_value_names.size()));
  return {};
}

// The layout for the kernel. All points must be in the chains before, because planning sorts
// drivers by the lengths of their chains.
void PlanLanes(BindingData* data) {
  LanePlanner planner(data->chains, data->driver_value_names.size(), &data->points);
  VisitDriverSets(data->drivers, [&](auto& drivers) { drivers.Plan(&planner); });
  data->values = planner.Values();
  data->num_value_rows = planner.num_rows();
  data->weight_plan = MakeWeightPlan(data->weights);
}

}  // namespace

Result<RigBinding> RigBinding::Create(const Rig& rig, const Skeleton& skeleton,
                                      std::span<const std::string> blend_shape_names,
                                      const BindOptions& options) {
  FURROW_RETURN_IF_ERROR(CheckRigFields(rig));
  auto data = std::make_unique<BindingData>();
  data->rig = rig;
  // Drivers compare joints with joints above them, so only the rest pose needs to turn. Those that
  // measure roots convert with BindContext::ToPoseSpace().
  const bool turned = options.turn != glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  data->skeleton = turned ? TurnRoots(skeleton, options.turn) : skeleton;
  const BindSource source = SourceOf(rig, blend_shape_names);
  BindContext context(source, data->skeleton, options, &data->chains);
  FURROW_RETURN_IF_ERROR(context.ResolveAnchorAndPoses());
  ValueIndex value_index;
  FURROW_RETURN_IF_ERROR(BindDrivers(rig, &context, data.get(), &value_index));
  if (std::string warning = WarningOfModelSpace(rig); !warning.empty()) {
    context.Warn(std::move(warning));
  }
  // WeightTable checks the names in feeds; InfluenceTable relies on them.
  FURROW_RETURN_IF_ERROR(data->weights.Bind(rig, value_index));
  data->influences.Bind(rig, data->skeleton, value_index);
  PlanLanes(data.get());
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
std::vector<std::size_t> RigBinding::InfluencedPlaces() const {
  return data_->influences.Places();
}
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
