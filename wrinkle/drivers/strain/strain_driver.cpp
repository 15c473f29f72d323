// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/strain/strain_driver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "base/scalar.h"

namespace furrow::wrinkle {
namespace {

// The frame of a patch's places: the base joint's axes, the patch's centre and its radius.
struct PatchFrame {
  glm::vec3 centre{0.0f};
  float radius = 1.0f;
};

// The centroid and the largest distance from it. A patch in one point keeps the radius 1.
PatchFrame FrameOf(std::span<const glm::vec3> places) {
  PatchFrame frame;
  for (const glm::vec3& place : places) frame.centre += place / static_cast<float>(places.size());
  float radius = 0.0f;
  for (const glm::vec3& place : places) {
    radius = std::max(radius, glm::distance(place, frame.centre));
  }
  if (radius > 0.0f) frame.radius = radius;
  return frame;
}

// The joints and blend shapes of a driver as a stream has them.
struct Found {
  int base = kNoJoint;
  std::vector<int> joints;           // of the skeleton, each that it has
  std::vector<std::uint8_t> frames;  // per joint of the driver: into `joints`, or its size
  std::vector<int> blend_shapes;     // per shape of the driver; -1: the stream lacks it
};

Result<Found> Find(const std::string& owner, const StrainDriver& strain, BindContext* context) {
  Found found;
  const Result<int> base = context->Joint(owner, "joint", strain.joint);
  FURROW_RETURN_IF_ERROR(base);
  found.base = *base;
  std::vector<int> joints;
  for (const std::string& name : strain.joints) {
    const Result<int> joint = context->Joint(owner, "joints", name);
    FURROW_RETURN_IF_ERROR(joint);
    // Without the base joint there is nothing to measure the others from.
    joints.push_back(found.base == kNoJoint ? kNoJoint : *joint);
  }
  found.joints = joints;
  std::erase(found.joints, kNoJoint);
  std::uint8_t next = 0;
  for (const int joint : joints) {
    found.frames.push_back(joint == kNoJoint ? static_cast<std::uint8_t>(found.joints.size())
                                             : next++);
  }
  for (const StrainDriver::Shape& shape : strain.shapes) {
    const Result<int> blend_shape = context->BlendShape(owner, shape.blend_shape);
    FURROW_RETURN_IF_ERROR(blend_shape);
    found.blend_shapes.push_back(*blend_shape);
  }
  return found;
}

// True if the stream can move the patch: by all its joints, or by a blend shape.
bool CanMove(const Found& found) {
  const bool has_joints = found.base != kNoJoint && found.joints.size() == found.frames.size();
  return has_joints ||
         std::ranges::any_of(found.blend_shapes, [](int shape) { return shape >= 0; });
}

// Brings positions and deltas of a driver to the base joint's space, and to the skeleton's size.
struct PatchSpace {
  glm::mat4 to_base{1.0f};
  glm::vec3 origin{0.0f};  // of the base joint, in model space
  float scale = 1.0f;

  // `position` is an offset from the base joint along model axes, on a skeleton of size
  // `strain.size`.
  PatchSpace(const StrainDriver& strain, const BindContext& context, int base) {
    if (base == kNoJoint) return;  // only blend shapes move it, and ratios have no size
    if (strain.size > 0.0f && context.size() > 0.0f) scale = context.size() / strain.size;
    const glm::mat4& model = context.skeleton().rest_model()[base];
    to_base = glm::inverse(model);
    origin = glm::vec3(model[3]);
  }
  [[nodiscard]] glm::vec3 Place(const glm::vec3& position) const {
    return glm::vec3(to_base * glm::vec4(origin + scale * position, 1.0f));
  }
  [[nodiscard]] glm::vec3 Move(const glm::vec3& delta) const {
    return glm::mat3(to_base) * (scale * delta);
  }
};

// Adds four points per joint to the chains. Skinning needs each joint's affine motion relative to
// the base. Four points determine it: the patch's centre, and one point along each axis at the
// distance of the radius. Points near the patch keep the digits that points near a distant joint
// would lose.
void AddPoints(const Found& found, const PatchFrame& frame, BindContext* context,
               std::vector<int>* points) {
  const Skeleton& skeleton = context->skeleton();
  for (const int joint : found.joints) {
    const glm::mat4 base_to_joint =
        glm::inverse(skeleton.rest_model()[joint]) * skeleton.rest_model()[found.base];
    for (int axis = -1; axis < 3; ++axis) {
      glm::vec3 point = frame.centre;
      if (axis >= 0) point[axis] += frame.radius;
      const auto offset = glm::vec3(base_to_joint * glm::vec4(point, 1.0f));
      points->push_back(context->chains().Add(skeleton, joint, offset, found.base));
    }
  }
}

}  // namespace

Status StrainDriverSet::Bind(const std::string& name, const StrainDriver& strain, int first_value,
                             BindContext* context) {
  const std::string owner = "driver '" + name + "'";
  const Skeleton& skeleton = context->skeleton();
  const Result<Found> found = Find(owner, strain, context);
  FURROW_RETURN_IF_ERROR(found);
  if (!CanMove(*found)) return {};  // it rests at 0

  Entry entry;
  entry.first_value = first_value;
  entry.inverse_full = 1.0f / strain.full_compression;
  entry.first_point = static_cast<std::uint32_t>(points_.size());
  entry.num_joints = static_cast<std::uint32_t>(found->joints.size());
  const PatchSpace space(strain, *context, found->base);
  std::vector<glm::vec3> places;
  for (const StrainDriver::Vertex& vertex : strain.vertices) {
    places.push_back(space.Place(vertex.position));
  }
  const PatchFrame frame = FrameOf(places);
  entry.resting = Frame(glm::mat3(frame.radius));
  entry.resting[3] = frame.centre;
  AddPoints(*found, frame, context, &points_);
  entry.first_vertex = static_cast<std::uint32_t>(vertices_.size());
  // BindTriangles() poses the vertices, so it needs their places first.
  BindVertices(strain, found->frames, &entry);
  for (std::size_t i = 0; i < places.size(); ++i) {
    vertices_[entry.first_vertex + i].place = (places[i] - frame.centre) / frame.radius;
  }
  BindTriangles(strain, ToJointAxes(skeleton, found->base, strain.direction), skeleton.rest_pose(),
                context->chains(), &entry);
  if (entry.num_triangles == 0) {
    triangles_.resize(entry.first_triangle);
    return context->Unusable(owner, "no triangle of its patch has an area on this skeleton");
  }
  entry.first_shape = static_cast<std::uint32_t>(shapes_.size());
  for (std::size_t i = 0; i < strain.shapes.size(); ++i) {
    if (found->blend_shapes[i] < 0) continue;
    const StrainDriver::Shape& from = strain.shapes[i];
    Shape& shape = shapes_.emplace_back();
    shape.blend_shape = found->blend_shapes[i];
    shape.first_delta = static_cast<std::uint32_t>(deltas_.size());
    for (std::size_t k = 0; k < from.vertices.size(); ++k) {
      const glm::vec3 delta(from.deltas[3 * k], from.deltas[3 * k + 1], from.deltas[3 * k + 2]);
      deltas_.push_back(
          {static_cast<std::uint32_t>(from.vertices[k]), space.Move(delta) / frame.radius});
    }
    shape.num_deltas = static_cast<std::uint32_t>(from.vertices.size());
    shape_names_.push_back(from.blend_shape);
  }
  entry.num_shapes = static_cast<std::uint32_t>(shapes_.size()) - entry.first_shape;
  entries_.push_back(entry);
  return {};
}

void StrainDriverSet::BindVertices(const StrainDriver& strain, std::span<const std::uint8_t> frames,
                                   Entry* entry) {
  entry->num_vertices = static_cast<std::uint32_t>(strain.vertices.size());
  for (const StrainDriver::Vertex& from : strain.vertices) {
    PatchVertex vertex;
    // The check accepts sums within 1% of 1. Skinning needs a sum of exactly 1, or else plain
    // motion would look like strain.
    float sum = 0.0f;
    for (const float skin_weight : from.skin_weights) sum += skin_weight;
    std::size_t count = 0;
    for (std::size_t i = 0; i < from.joints.size(); ++i) {
      if (from.skin_weights[i] == 0.0f) continue;
      vertex.influences[count++] = {frames[static_cast<std::size_t>(from.joints[i])],
                                    from.skin_weights[i] / sum};
    }
    vertices_.push_back(vertex);
  }
}

void StrainDriverSet::BindTriangles(const StrainDriver& strain, const glm::vec3& direction,
                                    std::span<const Transform> rest_pose, const JointChains& chains,
                                    Entry* entry) {
  // The rest shape goes through the same skinning as every pose, so the rest pose has no strain,
  // whatever was rounded in the file.
  std::array<Frame, kMaxPatchJoints> frames;
  std::array<glm::vec3, kMaxPatchVertices> rest;
  EvaluatePoints(*entry, rest_pose, chains, frames);
  Pose(*entry, frames, {}, rest);
  entry->first_triangle = static_cast<std::uint32_t>(triangles_.size());
  float area = 0.0f;
  for (std::size_t i = 0; i + 2 < strain.triangles.size(); i += 3) {
    const int* corners = &strain.triangles[i];
    const auto triangle =
        MakeRestTriangle(rest[corners[0]], rest[corners[1]], rest[corners[2]], direction);
    if (!triangle) continue;
    PatchTriangle& added = triangles_.emplace_back();
    for (int k = 0; k < 3; ++k) added.corners[k] = static_cast<std::uint16_t>(corners[k]);
    added.rest = *triangle;
    area += triangle->area;
  }
  entry->num_triangles = static_cast<std::uint32_t>(triangles_.size()) - entry->first_triangle;
  entry->inverse_area = area > 0.0f ? 1.0f / area : 0.0f;
}

StrainDriverSet::Frame StrainDriverSet::MakeFrame(std::span<const glm::vec3, kFramePoints> points) {
  const glm::vec3& origin = points[0];
  return {points[1] - origin, points[2] - origin, points[3] - origin, origin};
}

void StrainDriverSet::EvaluatePoints(const Entry& entry, std::span<const Transform> local,
                                     const JointChains& chains, std::span<Frame> frames) const {
  const int* point = points_.data() + entry.first_point;
  for (std::uint32_t i = 0; i < entry.num_joints; ++i, point += kFramePoints) {
    std::array<glm::vec3, kFramePoints> points;
    for (std::size_t k = 0; k < kFramePoints; ++k) points[k] = chains.Evaluate(local, point[k]);
    frames[i] = MakeFrame(points);
  }
}

void StrainDriverSet::Morph(int index, std::span<const float> blend_shapes,
                            std::span<glm::vec3> places) const {
  MorphPlaces(entries_[static_cast<std::size_t>(index)], blend_shapes, places);
}

void StrainDriverSet::MorphPlaces(const Entry& entry, std::span<const float> blend_shapes,
                                  std::span<glm::vec3> places) const {
  for (std::uint32_t i = 0; i < entry.num_vertices; ++i) {
    places[i] = vertices_[entry.first_vertex + i].place;
  }
  for (std::uint32_t i = entry.first_shape; i < entry.first_shape + entry.num_shapes; ++i) {
    const Shape& shape = shapes_[i];
    const auto index = static_cast<std::size_t>(shape.blend_shape);
    const float coefficient = index < blend_shapes.size() ? blend_shapes[index] : 0.0f;
    if (coefficient == 0.0f) continue;
    for (const Delta& delta : std::span(deltas_).subspan(shape.first_delta, shape.num_deltas)) {
      places[delta.vertex] += coefficient * delta.move;
    }
  }
}

void StrainDriverSet::Pose(const Entry& entry, std::span<const Frame> frames,
                           std::span<const float> blend_shapes,
                           std::span<glm::vec3> positions) const {
  std::array<glm::vec3, kMaxPatchVertices> morphed;
  const bool morphs = entry.num_shapes > 0;
  if (morphs) MorphPlaces(entry, blend_shapes, morphed);
  for (std::uint32_t i = 0; i < entry.num_vertices; ++i) {
    const PatchVertex& vertex = vertices_[entry.first_vertex + i];
    const glm::vec4 place(morphs ? morphed[i] : vertex.place, 1.0f);
    glm::vec3 position(0.0f);
    for (const PatchVertex::Influence& influence : vertex.influences) {
      if (influence.skin_weight == 0.0f) break;  // most vertices have two or three influences
      const Frame& frame =
          influence.joint < entry.num_joints ? frames[influence.joint] : entry.resting;
      position += influence.skin_weight * (frame * place);
    }
    positions[i] = position;
  }
}

std::vector<StrainDriverSet::Frame> StrainDriverSet::Frames(int entry,
                                                            std::span<const Transform> local,
                                                            const JointChains& chains) const {
  const Entry& e = entries_[static_cast<std::size_t>(entry)];
  std::vector<Frame> frames(e.num_joints);
  EvaluatePoints(e, local, chains, frames);
  return frames;
}

StrainDriverSet::Measured StrainDriverSet::Measure(int entry, std::span<const Transform> local,
                                                   std::span<const float> blend_shapes,
                                                   const JointChains& chains) const {
  std::array<Frame, kMaxPatchJoints> frames;
  EvaluatePoints(entries_[entry], local, chains, frames);
  const PrincipalStretches stretches = Principal(MeanTensor(entries_[entry], frames, blend_shapes));
  return {.stretches = stretches, .shares = ShareCompression(stretches)};
}

CauchyGreen StrainDriverSet::MeanTensor(const Entry& e, std::span<const Frame> frames,
                                        std::span<const float> blend_shapes) const {
  std::array<glm::vec3, kMaxPatchVertices> positions;
  Pose(e, frames, blend_shapes, positions);
  // Tensors in axes of one direction may be averaged; stretches and angles may not. Large triangles
  // count more.
  CauchyGreen mean{0.0f, 0.0f, 0.0f};
  for (std::uint32_t i = e.first_triangle; i < e.first_triangle + e.num_triangles; ++i) {
    const PatchTriangle& triangle = triangles_[i];
    const CauchyGreen c =
        RightCauchyGreen(Deform(triangle.rest, positions[triangle.corners[0]],
                                positions[triangle.corners[1]], positions[triangle.corners[2]]));
    const float share = triangle.rest.area * e.inverse_area;
    mean.xx += share * c.xx;
    mean.xy += share * c.xy;
    mean.yy += share * c.yy;
  }
  return mean;
}

void StrainDriverSet::EvaluateFrames(int entry, std::span<const Frame> frames,
                                     std::span<const float> blend_shapes,
                                     std::span<float> values) const {
  WriteValues(entry, MeanTensor(entries_[entry], frames, blend_shapes), values);
}

void StrainDriverSet::WriteValues(int entry, const CauchyGreen& mean,
                                  std::span<float> values) const {
  const CompressionShares shares = ShareCompression(Principal(mean));
  const bool is_compressed = shares.compression > 0.0f;
  // A compression beyond the full one keeps its direction; the shares then sum to 1.
  const float share = Saturate(shares.compression * entries_[entry].inverse_full);
  const float gain = is_compressed ? share / shares.compression : 0.0f;
  values[0] = Saturate(gain * shares.along);
  values[1] = Saturate(gain * shares.across);
  values[2] = Saturate(gain * shares.diagonal_left);
  values[3] = Saturate(gain * shares.diagonal_right);
}

void StrainDriverSet::Plan(LanePlanner* planner) {
  std::vector<BoundPatch> patches;
  for (const Entry& entry : entries_) {
    patches.push_back(
        {.first_value = entry.first_value,
         .points = std::span(points_).subspan(entry.first_point, entry.num_joints * kFramePoints),
         .vertices = std::span(vertices_).subspan(entry.first_vertex, entry.num_vertices),
         .triangles = std::span(triangles_).subspan(entry.first_triangle, entry.num_triangles),
         .inverse_area = entry.inverse_area});
  }
  plan_ = PlanStrain(patches, kNumValues, planner);
}

void StrainDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (int i = 0; i < num_entries(); ++i) {
    const PrincipalStretches stretches =
        Measure(i, pose.local, pose.blend_shapes, pose.chains).stretches;
    // Directions are axes: both signs mean the same fold. Reports use angles in (-90, 90].
    glm::vec2 direction = stretches.smallest_direction;
    if (direction.x < 0.0f || (direction.x == 0.0f && direction.y < 0.0f)) direction = -direction;
    explanation->strains.push_back({.driver = pose.DriverName(first_value(i)),
                                    .smallest = stretches.smallest,
                                    .largest = stretches.largest,
                                    .degrees = std::atan2(direction.y, direction.x) / kDegrees});
    ExplainShapes(entries_[static_cast<std::size_t>(i)], pose, explanation);
  }
}

void StrainDriverSet::ExplainShapes(const Entry& entry, const SolvedPose& pose,
                                    DriverExplanation* explanation) const {
  for (std::uint32_t i = entry.first_shape; i < entry.first_shape + entry.num_shapes; ++i) {
    const float coefficient = pose.Coefficient(shapes_[i].blend_shape);
    if (coefficient == 0.0f) continue;
    explanation->shapes.push_back({.driver = pose.DriverName(entry.first_value),
                                   .blend_shape = shape_names_[i],
                                   .coefficient = coefficient});
  }
}

}  // namespace furrow::wrinkle
