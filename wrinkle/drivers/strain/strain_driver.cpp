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

// The patch's vertices at rest, in the base joint's space.
std::vector<glm::vec3> RestPlaces(const StrainDriver& strain, const BindContext& context,
                                  int base) {
  // `position` is an offset from the base joint along model axes, on a skeleton of size
  // `strain.size`.
  const float scale = strain.size > 0.0f ? context.size() / strain.size : 1.0f;
  const Skeleton& skeleton = context.skeleton();
  const glm::mat4& model = skeleton.rest_model()[base];
  const glm::mat4 to_base = glm::inverse(model);
  std::vector<glm::vec3> places;
  for (const StrainDriver::Vertex& vertex : strain.vertices) {
    const glm::vec3 position = glm::vec3(model[3]) + scale * vertex.position;
    places.emplace_back(to_base * glm::vec4(position, 1.0f));
  }
  return places;
}

}  // namespace

Status StrainDriverSet::Bind(const std::string& name, const StrainDriver& strain, int first_value,
                             BindContext* context) {
  const std::string owner = "driver '" + name + "'";
  const Skeleton& skeleton = context->skeleton();
  std::vector<int> joints;
  int base = kNoJoint;
  FURROW_RETURN_IF_ERROR(BindJoints(owner, strain, context, &joints, &base));
  if (joints.size() < strain.joints.size() || base == kNoJoint) return {};  // it rests at 0

  Entry entry;
  entry.first_value = first_value;
  entry.inverse_full = 1.0f / strain.full_compression;
  entry.first_point = static_cast<std::uint32_t>(points_.size());
  entry.num_joints = static_cast<std::uint32_t>(joints.size());
  const std::vector<glm::vec3> places = RestPlaces(strain, *context, base);
  const PatchFrame frame = FrameOf(places);
  // Skinning needs each joint's affine motion relative to the base. Four points determine it: the
  // patch's centre, and one point along each axis at the distance of the radius. Points near the
  // patch keep the digits that points near a distant joint would lose.
  for (const int joint : joints) {
    const glm::mat4 base_to_joint =
        glm::inverse(skeleton.rest_model()[joint]) * skeleton.rest_model()[base];
    for (int axis = -1; axis < 3; ++axis) {
      glm::vec3 point = frame.centre;
      if (axis >= 0) point[axis] += frame.radius;
      const auto offset = glm::vec3(base_to_joint * glm::vec4(point, 1.0f));
      points_.push_back(context->chains().Add(skeleton, joint, offset, base));
    }
  }
  entry.first_vertex = static_cast<std::uint32_t>(vertices_.size());
  // BindTriangles() skins the vertices, so it needs their places first.
  BindVertices(strain, &entry);
  for (std::size_t i = 0; i < places.size(); ++i) {
    vertices_[entry.first_vertex + i].place = (places[i] - frame.centre) / frame.radius;
  }
  BindTriangles(strain, skeleton, base, context->chains(), &entry);
  if (entry.num_triangles == 0) {
    triangles_.resize(entry.first_triangle);
    return context->Unusable(owner, "no triangle of its patch has an area on this skeleton");
  }
  entries_.push_back(entry);
  return {};
}

// `joints` becomes shorter than the driver's list if a joint is missing and may be.
Status StrainDriverSet::BindJoints(const std::string& owner, const StrainDriver& strain,
                                   BindContext* context, std::vector<int>* joints, int* base) {
  const Result<int> found = context->Joint(owner, "joint", strain.joint);
  FURROW_RETURN_IF_ERROR(found);
  *base = *found;
  for (const std::string& name : strain.joints) {
    const Result<int> joint = context->Joint(owner, "joints", name);
    FURROW_RETURN_IF_ERROR(joint);
    if (*joint != kNoJoint) joints->push_back(*joint);
  }
  return {};
}

void StrainDriverSet::BindVertices(const StrainDriver& strain, Entry* entry) {
  entry->num_vertices = static_cast<std::uint32_t>(strain.vertices.size());
  for (const StrainDriver::Vertex& from : strain.vertices) {
    Vertex vertex;
    // The check accepts sums within 1% of 1. Skinning needs a sum of exactly 1, or else plain
    // motion would look like strain.
    float sum = 0.0f;
    for (const float skin_weight : from.skin_weights) sum += skin_weight;
    for (std::size_t i = 0; i < from.joints.size(); ++i) {
      vertex.influences[i] = {static_cast<std::uint8_t>(from.joints[i]),
                              from.skin_weights[i] / sum};
    }
    vertices_.push_back(vertex);
  }
}

void StrainDriverSet::BindTriangles(const StrainDriver& strain, const Skeleton& skeleton, int base,
                                    const JointChains& chains, Entry* entry) {
  // The rest shape goes through the same skinning as every pose, so the rest pose has no strain,
  // whatever was rounded in the file.
  std::array<Frame, kMaxPatchJoints> frames;
  std::array<glm::vec3, kMaxPatchVertices> rest;
  EvaluatePoints(*entry, skeleton.rest_pose(), chains, frames);
  Skin(*entry, frames, rest);
  const glm::vec3 direction = ToJointAxes(skeleton, base, strain.direction);
  entry->first_triangle = static_cast<std::uint32_t>(triangles_.size());
  float area = 0.0f;
  for (std::size_t i = 0; i + 2 < strain.triangles.size(); i += 3) {
    const int* corners = &strain.triangles[i];
    const auto triangle =
        MakeRestTriangle(rest[corners[0]], rest[corners[1]], rest[corners[2]], direction);
    if (!triangle) continue;
    Triangle& added = triangles_.emplace_back();
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

void StrainDriverSet::Skin(const Entry& entry, std::span<const Frame> frames,
                           std::span<glm::vec3> positions) const {
  for (std::uint32_t i = 0; i < entry.num_vertices; ++i) {
    const Vertex& vertex = vertices_[entry.first_vertex + i];
    glm::vec3 position(0.0f);
    for (const Influence& influence : vertex.influences) {
      if (influence.skin_weight == 0.0f) continue;  // most vertices have two or three influences
      const Frame& frame = frames[influence.joint];
      position += influence.skin_weight * (frame * glm::vec4(vertex.place, 1.0f));
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
                                                   const JointChains& chains) const {
  std::array<Frame, kMaxPatchJoints> frames;
  EvaluatePoints(entries_[entry], local, chains, frames);
  return MeasureFrames(entries_[entry], frames);
}

StrainDriverSet::Measured StrainDriverSet::MeasureFrames(const Entry& e,
                                                         std::span<const Frame> frames) const {
  std::array<glm::vec3, kMaxPatchVertices> positions;
  Skin(e, frames, positions);
  // Tensors in axes of one direction may be averaged; stretches and angles may not. Large triangles
  // count more.
  CauchyGreen mean{0.0f, 0.0f, 0.0f};
  for (std::uint32_t i = e.first_triangle; i < e.first_triangle + e.num_triangles; ++i) {
    const Triangle& triangle = triangles_[i];
    const CauchyGreen c =
        RightCauchyGreen(Deform(triangle.rest, positions[triangle.corners[0]],
                                positions[triangle.corners[1]], positions[triangle.corners[2]]));
    const float share = triangle.rest.area * e.inverse_area;
    mean.xx += share * c.xx;
    mean.xy += share * c.xy;
    mean.yy += share * c.yy;
  }
  const PrincipalStretches stretches = Principal(mean);
  return {.stretches = stretches, .shares = ShareCompression(stretches)};
}

void StrainDriverSet::EvaluateFrames(int entry, std::span<const Frame> frames,
                                     std::span<float> values) const {
  const CompressionShares shares = MeasureFrames(entries_[entry], frames).shares;
  const bool is_compressed = shares.compression > 0.0f;
  // A compression beyond the full one keeps its direction; the shares then sum to 1.
  const float share = Saturate(shares.compression * entries_[entry].inverse_full);
  const float gain = is_compressed ? share / shares.compression : 0.0f;
  values[0] = Saturate(gain * shares.along);
  values[1] = Saturate(gain * shares.across);
  values[2] = Saturate(gain * shares.diagonal_left);
  values[3] = Saturate(gain * shares.diagonal_right);
}

// The joints of all patches are planned one after another, four points each.
void StrainDriverSet::Plan(LanePlanner* planner) {
  std::vector<std::pair<const int*, std::uint32_t>> frames;  // four points, driver's first value
  for (int i = 0; i < num_entries(); ++i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    SingleDriver driver{.entry = i,
                        .first_value = static_cast<std::uint32_t>(entry.first_value),
                        .num_values = kNumValues,
                        .first_lane = static_cast<std::uint32_t>(frames.size()),
                        .num_lanes = entry.num_joints};
    planner->PlaceSingle(&driver);
    drivers_.push_back(driver);
    for (std::uint32_t k = 0; k < entry.num_joints; ++k) {
      frames.emplace_back(&points_[entry.first_point + k * kFramePoints], driver.first_value);
    }
  }
  // Drivers are in the order of the rig, so the first driver of a block has its lowest value. A
  // level of detail that skips the block needs none of its points.
  for (std::size_t first = 0; first < frames.size(); first += kRowLanes) {
    StrainFrameBlock& block = frame_blocks_.emplace_back();
    block.first_value = frames[first].second;
    block.first_row = planner->AddRows(3 * kFramePoints);
    for (std::size_t corner = 0; corner < kFramePoints; ++corner) {
      Lanes lanes;
      for (std::size_t i = first; i < std::min(first + kRowLanes, frames.size()); ++i) {
        lanes.Add(frames[i].first[corner]);
      }
      const std::uint32_t row = planner->AddPoints(lanes);
      if (corner == 0) block.first_point = row;
      block.num_lanes = static_cast<std::uint32_t>(lanes.count);
    }
  }
}

void StrainDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (int i = 0; i < num_entries(); ++i) {
    const PrincipalStretches stretches = Measure(i, pose.local, pose.chains).stretches;
    // Directions are axes: both signs mean the same fold. Reports use angles in (-90, 90].
    glm::vec2 direction = stretches.smallest_direction;
    if (direction.x < 0.0f || (direction.x == 0.0f && direction.y < 0.0f)) direction = -direction;
    explanation->strains.push_back({.driver = pose.DriverName(first_value(i)),
                                    .smallest = stretches.smallest,
                                    .largest = stretches.largest,
                                    .degrees = std::atan2(direction.y, direction.x) / kDegrees});
  }
}

}  // namespace furrow::wrinkle
