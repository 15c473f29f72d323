// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_driver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/drivers/pose/nnls.h"
#include "wrinkle/drivers/pose/pose_projection.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {
namespace {

// Below this share of the skeleton's size a displacement is rounding, not a pose.
constexpr float kLeastDisplacement = 1e-6f;
// Added to the Gram matrix's diagonal (which is about 1): poses that nearly coincide share their
// weight instead of trading it back and forth from frame to frame.
constexpr double kRidge = 1e-7;

std::string Whose(const Driver& driver) { return "driver '" + driver.name + "'"; }

glm::vec3 LocalOffset(const ControlPoint& point, const Skeleton& skeleton, int joint, float size) {
  switch (point.kind) {
    case ControlPoint::Kind::kTail: return skeleton.tails()[joint];
    case ControlPoint::Kind::kOrigin: return glm::vec3(0.0f);
    case ControlPoint::Kind::kOffset: break;
  }
  return point.offset_size > 0.0f ? point.offset * (size / point.offset_size) : point.offset;
}

}  // namespace

Status PoseDriverSet::Bind(const Driver& driver, int first_value, BindContext* context) {
  Entry entry;
  entry.first_value = first_value;
  entry.num_values = static_cast<int>(driver.pose.values.size());
  entry.first_point = static_cast<std::uint32_t>(points_.size());
  entry.first_displacement = static_cast<std::uint32_t>(displacements_.size());
  entry.first_square = static_cast<std::uint32_t>(squared_displacements_.size());
  entry.solve = driver.pose.solve;
  entry.falloff = driver.pose.falloff;
  bool usable = false;
  FURROW_RETURN_IF_ERROR(BindPoints(driver, context, &usable));
  if (!usable) return {};
  entry.num_points = static_cast<std::uint32_t>(points_.size()) - entry.first_point;
  for (const PoseDriver::Value& value : driver.pose.values) {
    FURROW_RETURN_IF_ERROR(BindValue(driver, value, entry, context));
  }
  if (entry.solve == PoseSolve::kNnls) {
    BindGram(&entry);
    nnls_entries_.push_back(num_entries());
  }
  entries_.push_back(entry);
  return {};
}

Status PoseDriverSet::BindPoints(const Driver& driver, BindContext* context, bool* usable) {
  const Skeleton& skeleton = context->skeleton();
  std::vector<int> joints;
  *usable = !context->anchor_missing();
  for (const ControlPoint& point : driver.pose.points) {
    const Result<int> joint = context->Joint(Whose(driver), "points", point.joint);
    FURROW_RETURN_IF_ERROR(joint);
    joints.push_back(*joint);
    *usable = *usable && *joint != kNoJoint;
  }
  if (!*usable) return {};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (context->anchor() != kNoJoint && !skeleton.IsAncestor(context->anchor(), joints[i])) {
      context->Warn(Whose(driver) + ": joint '" + driver.pose.points[i].joint +
                    "' does not hang from the anchor, so moving the anchor moves its value");
    }
    const glm::vec3 offset =
        LocalOffset(driver.pose.points[i], skeleton, joints[i], context->size());
    const int point = context->chains().Add(skeleton, joints[i], offset, context->anchor());
    points_.push_back({point, context->chains().Evaluate(skeleton.rest_pose(), point)});
  }
  return {};
}

Status PoseDriverSet::BindValue(const Driver& driver, const PoseDriver::Value& value,
                                const Entry& entry, BindContext* context) {
  const std::vector<Transform>* locals = context->ReferenceLocals(value.reference_pose);
  if (locals == nullptr) {
    return {StatusCode::kNotFound, Whose(driver) + ": value '" + value.name +
                                       "' names reference pose '" + value.reference_pose +
                                       "', which the rig does not have"};
  }
  const std::size_t first = displacements_.size();
  for (std::uint32_t i = entry.first_point; i < entry.first_point + entry.num_points; ++i) {
    displacements_.push_back(context->chains().Evaluate(*locals, points_[i].point) -
                             points_[i].rest);
  }
  const StackedPoints d = StackedPoints(displacements_).subspan(first);
  const double square = Dot(d, d);
  // What is too small to be squared does not move either.
  const bool moves = std::sqrt(square) > double{kLeastDisplacement * context->size()} &&
                     static_cast<float>(square) > 0.0f;
  squared_displacements_.push_back(moves ? static_cast<float>(square) : 0.0f);
  inverse_lengths_.push_back(moves ? 1.0 / std::sqrt(double{squared_displacements_.back()}) : 0.0);
  for (const glm::vec3& point : d) {
    projections_.push_back(Projection(point, squared_displacements_.back()));
  }
  if (!moves) {
    context->Warn(Whose(driver) + ": reference pose '" + value.reference_pose +
                  "' does not move its control points, so value '" + value.name + "' stays 0");
  }
  return {};
}

void PoseDriverSet::BindGram(Entry* entry) {
  std::vector<double> gram;
  for (int row = 0; row < entry->num_values; ++row) {
    for (int column = 0; column < entry->num_values; ++column) {
      const double norm = std::sqrt(double{squared_displacements_[entry->first_square + row]} *
                                    double{squared_displacements_[entry->first_square + column]});
      // Not simply 1 on the diagonal: the norm is rounded, alike in every entry.
      double cosine = row == column ? 1.0 : 0.0;
      if (norm > 0.0) cosine = Dot(Displacement(*entry, row), Displacement(*entry, column)) / norm;
      gram.push_back(row == column ? cosine + kRidge : cosine);
    }
  }
  entry->nnls = static_cast<std::uint32_t>(nnls_.size());
  nnls_.emplace_back(gram);
}

StackedPoints PoseDriverSet::Displacement(const Entry& entry, int value) const {
  return StackedPoints(displacements_)
      .subspan(entry.first_displacement + entry.num_points * static_cast<std::uint32_t>(value),
               entry.num_points);
}

StackedPoints PoseDriverSet::Displacement(int entry, int value) const {
  return Displacement(entries_[entry], value);
}

float PoseDriverSet::SquaredDisplacement(int entry, int value) const {
  return squared_displacements_[entries_[entry].first_square + static_cast<std::uint32_t>(value)];
}

int PoseDriverSet::Measure(int entry, std::span<const Transform> local, const JointChains& chains,
                           std::span<glm::vec3> moved) const {
  const Entry& e = entries_[entry];
  for (std::uint32_t i = 0; i < e.num_points; ++i) {
    const Measured& point = points_[e.first_point + i];
    moved[i] = chains.Evaluate(local, point.point) - point.rest;
  }
  return static_cast<int>(e.num_points);
}

void PoseDriverSet::Solve(int entry, StackedPoints moved, std::span<Fit> fits) const {
  SolveAlong(entries_[entry], moved, fits);
  SolvePerpendicular(entries_[entry], moved, fits);
}

void PoseDriverSet::SolveAlong(const Entry& entry, StackedPoints moved, std::span<Fit> fits) const {
  if (entry.solve == PoseSolve::kNnls) return SolveNonNegative(entry, moved, fits);
  for (int k = 0; k < entry.num_values; ++k) {
    fits[k].along = ProjectionAlong(moved, projections(entry, k));
  }
}

void PoseDriverSet::SolveNonNegative(const Entry& entry, StackedPoints moved,
                                     std::span<Fit> fits) const {
  const std::size_t count = static_cast<std::size_t>(entry.num_values);
  const double* inverse_lengths = inverse_lengths_.data() + entry.first_square;
  std::array<double, kMaxNnlsValues> rhs;
  std::array<double, kMaxNnlsValues> lengths;  // the unknowns: along unit displacements
  for (int k = 0; k < entry.num_values; ++k) {
    rhs[k] = Dot(moved, Displacement(entry, k)) * inverse_lengths[k];
  }
  nnls_[entry.nnls].Solve(std::span(rhs).first(count), std::span(lengths).first(count));
  for (int k = 0; k < entry.num_values; ++k) {
    fits[k].along = static_cast<float>(lengths[k] * inverse_lengths[k]);
  }
}

void PoseDriverSet::SolvePerpendicular(const Entry& entry, StackedPoints moved,
                                       std::span<Fit> fits) const {
  if (entry.solve != PoseSolve::kNnls) {
    for (int k = 0; k < entry.num_values; ++k) {
      fits[k].squared_perpendicular = SquaredDistance(moved, Displacement(entry, k), fits[k].along);
    }
    return;
  }
  std::array<glm::vec3, kMaxControlPoints> left_over;
  std::copy(moved.begin(), moved.end(), left_over.begin());
  for (int k = 0; k < entry.num_values; ++k) {
    if (fits[k].along <= 0.0f) continue;
    const StackedPoints d = Displacement(entry, k);
    for (std::size_t i = 0; i < moved.size(); ++i) left_over[i] -= fits[k].along * d[i];
  }
  const StackedPoints residual = StackedPoints(left_over).first(moved.size());
  const auto squared_residual = static_cast<float>(Dot(residual, residual));
  for (int k = 0; k < entry.num_values; ++k) fits[k].squared_perpendicular = squared_residual;
}

float PoseDriverSet::Value(int entry, int value, const Fit& fit) const {
  const float square = SquaredDisplacement(entry, value);
  if (square <= 0.0f) return 0.0f;
  return Saturate(Saturate(fit.along) *
                  Falloff(fit.squared_perpendicular, square, entries_[entry].falloff));
}

void PoseDriverSet::Evaluate(std::span<const Transform> local, const JointChains& chains,
                             std::span<float> driver_values) const {
  std::array<glm::vec3, kMaxControlPoints> moved;
  for (int i = 0; i < num_entries() && Reaches(driver_values, first_value(i)); ++i) {
    const auto num_points = static_cast<std::size_t>(Measure(i, local, chains, moved));
    EvaluateMoved(i, StackedPoints(moved).first(num_points),
                  driver_values.subspan(static_cast<std::size_t>(first_value(i)),
                                        static_cast<std::size_t>(num_values(i))));
  }
}

void PoseDriverSet::EvaluateMoved(int entry, StackedPoints moved, std::span<float> values) const {
  std::array<Fit, kMaxPoseValues> fits;
  SolveAlong(entries_[entry], moved, fits);
  if (falloff(entry) > 0.0f) SolvePerpendicular(entries_[entry], moved, fits);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = Value(entry, static_cast<int>(k), fits[k]);
  }
}

}  // namespace furrow::wrinkle
