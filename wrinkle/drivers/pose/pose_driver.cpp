// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_driver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/scalar.h"
#include "wrinkle/drivers/pose/pose_gram.h"

namespace furrow::wrinkle {
namespace {

// A displacement below this share of the skeleton's size is rounding, not a pose.
constexpr float kLeastDisplacement = 1e-6f;
// The same for the coefficients of a pose, as a length.
constexpr double kLeastCoefficients = 1e-4;
// What a coefficient counts as beside joints that no reference pose moves: a share of the
// skeleton's size.
constexpr float kUnitBesideRest = 0.01f;

std::string OwnerOf(const std::string& name) { return "driver '" + name + "'"; }

// In double: the terms of long vectors cancel.
template <class Vector>
double Dot(StackedPoints a, std::span<const Vector> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(glm::dvec3(a[i]), glm::dvec3(b[i]));
  return sum;
}

float SquaredLength(StackedPoints points) { return static_cast<float>(Dot(points, points)); }

// "'a' and 'b'", "'a', 'b' and 'c'".
std::string Listed(const std::vector<int>& values, const PoseDriver& driver) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i + 1 == values.size() ? " and " : ", ";
    text += "'" + driver.values[static_cast<std::size_t>(values[i])].reference_pose + "'";
  }
  return text;
}

// The warning about poses that depend on one another.
std::string Describe(const PoseDependence& dependence, const PoseDriver& driver) {
  char cosine[32];
  std::snprintf(cosine, sizeof cosine, "%.4f", dependence.cosine);
  const std::string poses = "reference poses " + Listed(dependence.poses, driver);
  const std::string with_cosine = std::string(" (cosine ") + cosine;
  if (dependence.poses.size() > 2) {
    return poses + " are almost mixes of one another" + with_cosine +
           " between one and a mix of the others), so noise moves their values; remove one, or add "
           "points that distinguish them";
  }
  const bool opposite = dependence.cosine < 0.0;
  return poses + " move its control points in almost " +
         (opposite ? "opposite directions" : "the same direction") + with_cosine +
         "), so noise moves their values; remove one, or add points that distinguish them";
}

// How far a reference pose moves a point. In double precision, because d is often a thousandth of
// B.
glm::dvec3 PointDisplacement(const std::vector<PreciseTransform>& locals, int point,
                             const BindContext& context) {
  return context.chains().Evaluate(std::span<const PreciseTransform>(locals), point) -
         context.chains().Evaluate(context.rest_locals(), point);
}

// The control point in its joint's space. Offsets that state the size of their skeleton scale with
// this one, of size `size`.
glm::vec3 LocalOffset(const ControlPoint& point, const Skeleton& skeleton, int joint, float size) {
  switch (point.kind) {
    case ControlPoint::Kind::kTail: return skeleton.tails()[joint];
    case ControlPoint::Kind::kOrigin: return glm::vec3(0.0f);
    case ControlPoint::Kind::kOffset:
    case ControlPoint::Kind::kBlendShape: break;
  }
  return point.offset_size > 0.0f ? point.offset * (size / point.offset_size) : point.offset;
}

}  // namespace

Status PoseDriverSet::Bind(const std::string& name, const PoseDriver& driver, int first_value,
                           BindContext* context) {
  Entry entry;
  entry.first_value = first_value;
  entry.num_values = static_cast<int>(driver.values.size());
  entry.first_point = static_cast<std::uint32_t>(points_.size());
  entry.first_displacement = static_cast<std::uint32_t>(displacements_.size());
  entry.first_square = static_cast<std::uint32_t>(squares_.size());
  entry.solve = driver.solve;
  entry.falloff = driver.falloff;
  bool usable = false;
  FURROW_RETURN_IF_ERROR(BindShapes(name, driver, context, &entry));
  FURROW_RETURN_IF_ERROR(BindPoints(name, driver, context, &entry, &usable));
  if (!usable) return {};
  const float unit = ShapeUnit(driver, entry, *context);
  for (std::uint32_t i = 0; i < entry.num_shapes; ++i) shapes_[entry.first_shapes + i].unit = unit;
  PreciseVectors precise;
  for (const PoseDriver::Value& value : driver.values) {
    FURROW_RETURN_IF_ERROR(BindValue(name, value, entry, context, &precise));
  }
  if (entry.solve == PoseSolve::kNnls) BindGram(name, driver, precise, &entry, context);
  entries_.push_back(entry);
  return {};
}

Status PoseDriverSet::BindShapes(const std::string& name, const PoseDriver& driver,
                                 BindContext* context, Entry* entry) {
  entry->first_shapes = static_cast<std::uint32_t>(shapes_.size());
  std::size_t count = 0;
  for (const ControlPoint& point : driver.points) {
    if (point.kind != ControlPoint::Kind::kBlendShape) continue;
    const Result<int> found = context->BlendShape(OwnerOf(name), point.blend_shape);
    FURROW_RETURN_IF_ERROR(found);
    if (*found < 0) continue;
    const std::size_t place = count++ % 3;
    if (place == 0) {
      shapes_.emplace_back();
      shape_names_.resize(3 * shapes_.size());
    }
    shapes_.back().blend_shapes[place] = *found;
    shape_names_[shape_names_.size() - 3 + place] = point.blend_shape;
  }
  entry->num_shapes = static_cast<std::uint32_t>(shapes_.size()) - entry->first_shapes;
  return {};
}

Status PoseDriverSet::BindPoints(const std::string& name, const PoseDriver& driver,
                                 BindContext* context, Entry* entry, bool* usable) {
  const Skeleton& skeleton = context->skeleton();
  const bool reads_joints = !JointsRead(driver).empty();
  int anchor = context->anchor();
  bool is_anchored = !context->anchor_missing();
  if (reads_joints && !driver.anchor.empty()) {
    const Result<int> own = context->Joint(OwnerOf(name), "anchor", driver.anchor);
    FURROW_RETURN_IF_ERROR(own);
    anchor = *own;
    is_anchored = anchor != kNoJoint;
  }
  std::vector<std::pair<const ControlPoint*, int>> found;
  bool is_complete = reads_joints && is_anchored;
  for (const ControlPoint& point : driver.points) {
    if (point.kind == ControlPoint::Kind::kBlendShape) continue;
    const Result<int> joint = context->Joint(OwnerOf(name), "points", point.joint);
    FURROW_RETURN_IF_ERROR(joint);
    if (*joint != kNoJoint && is_anchored) found.emplace_back(&point, *joint);
    is_complete = is_complete && *joint != kNoJoint;
  }
  *usable = is_complete || entry->num_shapes > 0;
  if (!*usable) return {};
  entry->in_model_space = anchor == kNoJoint;
  // Points are measured in the anchor's space, so that a nod of the head makes no wrinkle (thesis
  // 4.1 leaves the space open).
  for (const auto& [control, joint] : found) {
    if (anchor != kNoJoint && !skeleton.IsAncestor(anchor, joint)) {
      context->Warn(OwnerOf(name) + ": joint '" + control->joint +
                    "' does not hang from the anchor, so moving the anchor moves its value");
    }
    const glm::vec3 offset = LocalOffset(*control, skeleton, joint, context->size());
    const int point = context->chains().Add(skeleton, joint, offset, anchor);
    const glm::vec3 rest = context->chains().Evaluate(skeleton.rest_pose(), point);
    points_.push_back({point, entry->in_model_space ? context->ToPoseSpace(rest) : rest});
  }
  entry->num_points = static_cast<std::uint32_t>(points_.size()) - entry->first_point;
  return {};
}

float PoseDriverSet::ShapeUnit(const PoseDriver& driver, const Entry& entry,
                               const BindContext& context) const {
  if (entry.num_points == 0 || entry.num_shapes == 0) return 1.0f;
  double largest = 0.0;
  for (const PoseDriver::Value& value : driver.values) {
    const auto* const locals = context.ReferenceLocals(value.reference_pose);
    if (locals == nullptr) continue;  // BindValue() reports it
    for (const MeasuredPoint& point : points(entry)) {
      const glm::dvec3 d = PointDisplacement(*locals, point.point, context);
      largest = std::max(largest, glm::length(d));
    }
  }
  if (largest > double{kLeastDisplacement * context.size()}) return static_cast<float>(largest);
  return kUnitBesideRest * context.size();
}

Status PoseDriverSet::BindValue(const std::string& name, const PoseDriver::Value& value,
                                const Entry& entry, BindContext* context, PreciseVectors* precise) {
  const std::vector<PreciseTransform>* locals = context->ReferenceLocals(value.reference_pose);
  if (locals == nullptr) {
    return {StatusCode::kNotFound, OwnerOf(name) + ": value '" + value.name +
                                       "' names reference pose '" + value.reference_pose +
                                       "', which the rig does not have"};
  }
  // d of thesis 4.1, stacked over all control points and blend shapes: one vector of 3 (P + S)
  // numbers per value.
  const std::size_t first = precise->size();
  double square = 0.0;
  for (const MeasuredPoint& point : points(entry)) {
    const glm::dvec3 d = PointDisplacement(*locals, point.point, *context);
    precise->push_back(entry.in_model_space ? context->ToPoseSpace(d) : d);
    square += glm::dot(precise->back(), precise->back());
  }
  const bool joints_move = std::sqrt(square) > double{kLeastDisplacement * context->size()};
  double shape_square = 0.0;
  for (std::size_t i = entry.first_shapes; i < entry.first_shapes + entry.num_shapes; ++i) {
    glm::dvec3 coefficients(0.0);
    for (int k = 0; k < 3; ++k) {
      const std::string& shape = shape_names_[3 * i + static_cast<std::size_t>(k)];
      if (!shape.empty()) coefficients[k] = context->ReferenceShape(value.reference_pose, shape);
    }
    precise->push_back(double{shapes_[i].unit} * coefficients);
    shape_square += glm::dot(coefficients, coefficients);
    square += glm::dot(precise->back(), precise->back());
  }
  // A displacement with a square of 0 as a float does not move either.
  const bool moves = (joints_move || std::sqrt(shape_square) > kLeastCoefficients) &&
                     static_cast<float>(square) > 0.0f;
  squares_.push_back(moves ? static_cast<float>(square) : 0.0f);
  inverse_lengths_.push_back(moves ? 1.0 / std::sqrt(square) : 0.0);
  for (glm::dvec3& d : std::span(*precise).subspan(first)) {
    if (!moves) d = glm::dvec3(0.0);
    displacements_.emplace_back(d);
    projections_.emplace_back(moves ? d / square : d);
  }
  if (!moves) {
    context->Warn(OwnerOf(name) + ": reference pose '" + value.reference_pose +
                  "' does not move its control points, so value '" + value.name + "' stays 0");
  }
  return {};
}

void PoseDriverSet::BindGram(const std::string& name, const PoseDriver& driver,
                             const PreciseVectors& precise, Entry* entry, BindContext* context) {
  const PoseGram gram = MakePoseGram(precise, static_cast<std::size_t>(entry->num_values));
  for (const PoseDependence& dependence : gram.dependences) {
    context->Warn(OwnerOf(name) + ": " + Describe(dependence, driver));
  }
  entry->nnls = static_cast<std::uint32_t>(nnls_.size());
  entry->first_direction = static_cast<std::uint32_t>(directions_.size());
  directions_.insert(directions_.end(), gram.directions.begin(), gram.directions.end());
  nnls_.emplace_back(gram.gram);
}

BoundPose PoseDriverSet::Bound(const Entry& entry) const {
  const auto num_values = static_cast<std::size_t>(entry.num_values);
  // Displacements and projections have one vector per value and vector of the stack; squares have
  // one number per value.
  const std::size_t num_vectors = num_values * entry.num_vectors();
  return {.first_value = entry.first_value,
          .points = points(entry),
          .shapes = shapes(entry),
          .projections = std::span(projections_).subspan(entry.first_displacement, num_vectors),
          .displacements = std::span(displacements_).subspan(entry.first_displacement, num_vectors),
          .squares = std::span(squares_).subspan(entry.first_square, num_values),
          .falloff = entry.falloff};
}

void PoseDriverSet::Plan(LanePlanner* planner) {
  std::vector<BoundPose> projections;
  std::vector<BoundPose> nnls;
  std::vector<int> nnls_entries;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].solve == PoseSolve::kNnls) {
      nnls.push_back(Bound(entries_[i]));
      nnls_entries.push_back(static_cast<int>(i));
    } else {
      projections.push_back(Bound(entries_[i]));
    }
  }
  // Projections share lanes. An nnls driver branches on its own data, so only its points are
  // evaluated in lanes.
  PlanProjections(projections, planner, &plan_);
  PlanNnls(nnls, nnls_entries, planner, &plan_);
}

StackedPoints PoseDriverSet::Displacement(const Entry& entry, int value) const {
  return StackedPoints(displacements_)
      .subspan(entry.first_displacement + entry.num_vectors() * static_cast<std::uint32_t>(value),
               entry.num_vectors());
}

std::size_t PoseDriverSet::MoveShapes(int entry, std::span<const float> coefficients,
                                      std::span<glm::vec3> moved) const {
  const std::span<const MeasuredShapes> list = shapes(entries_[static_cast<std::size_t>(entry)]);
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto place =
          static_cast<std::size_t>(list[i].blend_shapes[static_cast<std::size_t>(k)]);
      moved[i][k] = place < coefficients.size() ? list[i].unit * coefficients[place] : 0.0f;
    }
  }
  return list.size();
}

void PoseDriverSet::SolveNnls(int entry, StackedPoints moved, std::span<float> along) const {
  const Entry& e = entries_[static_cast<std::size_t>(entry)];
  const auto count = static_cast<std::size_t>(e.num_values);
  const double* inverse_lengths = inverse_lengths_.data() + e.first_square;
  // Fixed arrays: this runs per pose and must not allocate.
  std::array<double, kMaxNnlsValues> rhs;
  std::array<double, kMaxNnlsValues> lengths;  // the unknowns: along unit displacements
  const std::span<const glm::dvec3> directions(directions_);
  for (std::size_t k = 0; k < count; ++k) {
    rhs[k] =
        Dot(moved, directions.subspan(e.first_direction + k * e.num_vectors(), e.num_vectors()));
  }
  nnls_[e.nnls].Solve(std::span(rhs).first(count), std::span(lengths).first(count));
  for (std::size_t k = 0; k < count; ++k) {
    along[k] = static_cast<float>(lengths[k] * inverse_lengths[k]);
  }
}

float PoseDriverSet::SquaredResidual(int entry, StackedPoints moved,
                                     std::span<const float> along) const {
  const Entry& e = entries_[static_cast<std::size_t>(entry)];
  std::array<glm::vec3, kMaxControlPoints> left_over;
  std::copy(moved.begin(), moved.end(), left_over.begin());
  for (int k = 0; k < e.num_values; ++k) {
    if (along[k] <= 0.0f) continue;
    const StackedPoints d = Displacement(e, k);
    for (std::size_t i = 0; i < moved.size(); ++i) left_over[i] -= along[k] * d[i];
  }
  return SquaredLength(StackedPoints(left_over).first(moved.size()));
}

void PoseDriverSet::ExplainShapes(const Entry& entry, const SolvedPose& pose,
                                  DriverExplanation* explanation) const {
  for (std::size_t i = 0; i < 3 * std::size_t{entry.num_shapes}; ++i) {
    const int place = shapes(entry)[i / 3].blend_shapes[i % 3];
    if (place < 0) continue;
    explanation->shapes.push_back(
        {.driver = pose.DriverName(entry.first_value),
         .blend_shape = shape_names_[3 * std::size_t{entry.first_shapes} + i],
         .coefficient = pose.Coefficient(place)});
  }
}

// The geometry is measured from the pose again; the results are those of the solver. The falloff is
// the factor that the solver applied.
void PoseDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    std::vector<glm::vec3> moved;
    for (const MeasuredPoint& point : points(entry)) {
      moved.push_back(pose.chains.Evaluate(pose.local, point.point) - point.rest);
    }
    moved.resize(entry.num_vectors());
    MoveShapes(static_cast<int>(i), pose.blend_shapes, std::span(moved).subspan(entry.num_points));
    ExplainShapes(entry, pose, explanation);
    std::vector<float> along(static_cast<std::size_t>(entry.num_values), 0.0f);
    const bool is_nnls = entry.solve == PoseSolve::kNnls;
    if (is_nnls) SolveNnls(static_cast<int>(i), moved, along);
    for (int k = 0; k < entry.num_values; ++k) {
      const StackedPoints d = Displacement(entry, k);
      const float square = SquaredDisplacement(entry, k);
      const double numerator = Dot(moved, d);
      if (!is_nnls && square > 0.0f) along[k] = static_cast<float>(numerator / double{square});
      float left_over = 0.0f;
      if (is_nnls) {
        left_over = SquaredResidual(static_cast<int>(i), moved, along);
      } else {
        std::vector<glm::vec3> off = moved;
        for (std::size_t p = 0; p < off.size(); ++p) off[p] -= along[k] * d[p];
        left_over = SquaredLength(off);
      }
      const auto value = static_cast<std::size_t>(entry.first_value + k);
      const float result = pose.driver_values[value];
      const bool fades = entry.falloff > 0.0f && along[k] > 0.0f;
      explanation->pose_values.push_back({.driver_value = pose.driver_value_names[value],
                                          .displacement = std::sqrt(square),
                                          .moved = std::sqrt(SquaredLength(moved)),
                                          .numerator = static_cast<float>(numerator),
                                          .along = along[k],
                                          .perpendicular = std::sqrt(left_over),
                                          .falloff = fades ? result / Saturate(along[k]) : 1.0f,
                                          .result = result});
    }
  }
}

}  // namespace furrow::wrinkle
