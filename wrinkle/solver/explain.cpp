// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/explain.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/scalar.h"
#include "wrinkle/drivers/pose/pose_projection.h"
#include "wrinkle/solver/binding_data.h"
#include "wrinkle/weights/incongruence.h"

namespace furrow::wrinkle {
namespace {

Explanation::Weight ExplainWeight(const BindingData& data, int weight,
                                  std::span<const float> driver_values,
                                  std::span<const float> modulated) {
  const WeightTable& table = data.weights;
  Explanation::Weight result;
  result.name = table.names()[weight];
  for (const WeightSource& source : table.sources(weight)) {
    const float value = driver_values[source.driver_value];
    result.contributions.push_back({.driver_value = data.driver_value_names[source.driver_value],
                                    .value = value,
                                    .gain = source.gain,
                                    .product = source.gain * value});
  }
  result.combined = table.Combined(weight, driver_values);
  result.modulated = modulated[weight];
  for (const std::uint16_t opponent : table.opponents(weight)) {
    result.conflicts.push_back(
        {.weight = table.names()[opponent],
         .other = modulated[opponent],
         .factor = CongruenceFactor(modulated[weight], modulated[opponent])});
  }
  result.result = modulated[weight] * table.Congruence(weight, modulated);
  return result;
}

std::vector<Explanation::PoseValue> ExplainPoseDrivers(const BindingData& data,
                                                       std::span<const Transform> local) {
  const PoseDriverSet& drivers = data.pose_drivers;
  std::array<glm::vec3, kMaxControlPoints> points;
  std::array<PoseDriverSet::Fit, kMaxPoseValues> fits;
  std::vector<Explanation::PoseValue> values;
  for (int i = 0; i < drivers.num_entries(); ++i) {
    const int num_points = drivers.Measure(i, local, data.chains, points);
    const StackedPoints moved = StackedPoints(points).first(static_cast<std::size_t>(num_points));
    drivers.Solve(i, moved, fits);
    for (int k = 0; k < drivers.num_values(i); ++k) {
      const float square = drivers.SquaredDisplacement(i, k);
      values.push_back(
          {.driver_value = data.driver_value_names[drivers.first_value(i) + k],
           .displacement = std::sqrt(square),
           .moved = static_cast<float>(std::sqrt(Dot(moved, moved))),
           .numerator = static_cast<float>(Dot(moved, drivers.Displacement(i, k))),
           .along = fits[k].along,
           .perpendicular = std::sqrt(fits[k].squared_perpendicular),
           .falloff = Falloff(fits[k].squared_perpendicular, square, drivers.falloff(i)),
           .result = drivers.Value(i, k, fits[k])});
    }
  }
  return values;
}

std::string DriverOf(const BindingData& data, int first_value) {
  const std::string& name = data.driver_value_names[first_value];
  return name.substr(0, name.rfind('.'));
}

std::vector<Explanation::Angle> ExplainAngles(const BindingData& data,
                                              std::span<const Transform> local) {
  std::vector<Explanation::Angle> angles;
  for (int i = 0; i < data.hinge_drivers.num_entries(); ++i) {
    angles.push_back({.driver = DriverOf(data, data.hinge_drivers.first_value(i)),
                      .what = "flexion",
                      .degrees = data.hinge_drivers.AngleDegrees(i, local, data.chains)});
  }
  for (int i = 0; i < data.ball_drivers.num_entries(); ++i) {
    const std::string driver = DriverOf(data, data.ball_drivers.first_value(i));
    const BallDriverSet::Bending bending = data.ball_drivers.Measure(i, local, data.chains);
    const float across = std::hypot(bending.forward, bending.right);
    angles.push_back({.driver = driver,
                      .what = "bend",
                      .degrees = std::atan2(across, bending.cosine) / kDegrees});
    angles.push_back({.driver = driver,
                      .what = "direction",
                      .degrees = std::atan2(bending.right, bending.forward) / kDegrees});
  }
  for (int i = 0; i < data.twist_drivers.num_entries(); ++i) {
    angles.push_back({.driver = DriverOf(data, data.twist_drivers.first_value(i)),
                      .what = "twist",
                      .degrees = data.twist_drivers.Angle(i, local) / kDegrees});
  }
  return angles;
}

std::vector<Explanation::Strain> ExplainStrains(const BindingData& data,
                                                std::span<const Transform> local) {
  const StrainDriverSet& drivers = data.strain_drivers;
  std::vector<Explanation::Strain> strains;
  for (int i = 0; i < drivers.num_entries(); ++i) {
    const PrincipalStretches stretches = drivers.Measure(i, local, data.chains).stretches;
    glm::vec2 direction = stretches.smallest_direction;
    if (direction.x < 0.0f || (direction.x == 0.0f && direction.y < 0.0f)) direction = -direction;
    strains.push_back({.driver = DriverOf(data, drivers.first_value(i)),
                       .smallest = stretches.smallest,
                       .largest = stretches.largest,
                       .degrees = std::atan2(direction.y, direction.x) / kDegrees});
  }
  return strains;
}

}  // namespace

JobStatus Explain(const RigBinding& binding, const LocalPose& pose, Explanation* explanation) {
  const BindingData& data = binding.data();
  std::vector<float> driver_values(data.driver_value_names.size());
  const DriverJob drivers{.binding = &binding,
                          .local = pose.joints,
                          .blend_shapes = pose.blend_shapes,
                          .driver_values = driver_values};
  if (const JobStatus status = drivers.Run(); status != JobStatus::kOk) return status;

  const int num_weights = static_cast<int>(data.weights.names().size());
  std::vector<float> modulated;
  for (int i = 0; i < num_weights; ++i) {
    modulated.push_back(data.weights.Modulated(i, driver_values));
  }
  Explanation result;
  for (int i = 0; i < num_weights; ++i) {
    result.weights.push_back(ExplainWeight(data, i, driver_values, modulated));
  }
  result.pose_values = ExplainPoseDrivers(data, pose.joints);
  result.angles = ExplainAngles(data, pose.joints);
  result.strains = ExplainStrains(data, pose.joints);
  *explanation = std::move(result);
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle
