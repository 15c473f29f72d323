// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x3.hpp>

#include "wrinkle/drivers/common/bind_context.h"
#include "wrinkle/drivers/common/driver_explanation.h"
#include "wrinkle/drivers/strain/strain.h"
#include "wrinkle/drivers/strain/strain_fields.h"
#include "wrinkle/drivers/strain/strain_plan.h"
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// All strain drivers of a binding. Private to wrinkle/. The formulas are in strain.h;
// strain_lanes-inl.h evaluates the drivers.
//
// Blend shapes move the vertices of a patch first. Then the patch is skinned with the motion of its
// joints relative to the driver's base joint. Each joint's motion is known from four points: the
// patch's centre and one point along each axis. A motion of the whole character therefore changes
// nothing, and the small differences that make up strain are not lost in the distance to the
// joints.
//
// If a stream moves the patch by blend shapes, joints that it lacks stay where they are relative to
// the base joint. Otherwise a driver with a missing joint rests at 0.
class StrainDriverSet {
 public:
  static constexpr int kNumValues = 4;

  // Maps a point of the patch at rest to where a joint takes it, in the base joint's space.
  using Frame = glm::mat4x3;

  struct Measured {
    PrincipalStretches stretches;
    CompressionShares shares;  // not yet divided by the full compression
  };

  [[nodiscard]] Status Bind(const std::string& name, const StrainDriver& driver, int first_value,
                            BindContext* context);
  // Lays the drivers out in blocks. Call it once, after the last Bind().
  void Plan(LanePlanner* planner);
  // Adds the principal stretches of each patch, and the blend shapes that move it.
  void Explain(const SolvedPose& pose, DriverExplanation* explanation) const;

  [[nodiscard]] static Frame MakeFrame(std::span<const glm::vec3, kFramePoints> points);
  // The values of one driver, without lanes. `frames`: one per joint that moves the patch.
  // `blend_shapes`: the stream's coefficients; missing ones count as 0. `values`: kNumValues.
  void EvaluateFrames(int entry, std::span<const Frame> frames, std::span<const float> blend_shapes,
                      std::span<float> values) const;
  // The same from the patch's mean tensor.
  void WriteValues(int entry, const CauchyGreen& mean, std::span<float> values) const;

  // What the lanes need of an entry besides its plan.
  [[nodiscard]] bool has_shapes(int entry) const {
    return entries_[static_cast<std::size_t>(entry)].num_shapes > 0;
  }
  // The frame of a joint that does not move relative to the base joint.
  [[nodiscard]] const Frame& resting(int entry) const {
    return entries_[static_cast<std::size_t>(entry)].resting;
  }
  // The patch's vertices, moved by blend shapes alone.
  void Morph(int entry, std::span<const float> blend_shapes, std::span<glm::vec3> places) const;
  [[nodiscard]] const StrainPlan& plan() const { return plan_; }

  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const {
    return entries_[static_cast<std::size_t>(entry)].first_value;
  }
  // The frames of an entry's joints in a pose, without lanes.
  [[nodiscard]] std::vector<Frame> Frames(int entry, std::span<const Transform> local,
                                          const JointChains& chains) const;
  // The strain in a pose, without lanes.
  [[nodiscard]] Measured Measure(int entry, std::span<const Transform> local,
                                 std::span<const float> blend_shapes,
                                 const JointChains& chains) const;

 private:
  struct Entry {
    int first_value = 0;
    float inverse_full = 4.0f;
    std::uint32_t first_point = 0;  // into points_: four per joint
    std::uint32_t num_joints = 0;   // that the skeleton has
    std::uint32_t first_vertex = 0;
    std::uint32_t num_vertices = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t num_triangles = 0;
    std::uint32_t first_shape = 0;
    std::uint32_t num_shapes = 0;
    float inverse_area = 0.0f;  // of all triangles
    Frame resting{1.0f};
  };
  // A blend shape that moves the entry's vertices.
  struct Shape {
    int blend_shape = 0;  // index into the stream's coefficients
    std::uint32_t first_delta = 0;
    std::uint32_t num_deltas = 0;
  };
  struct Delta {
    std::uint32_t vertex = 0;  // of the entry's
    glm::vec3 move{0.0f};      // at coefficient 1, in the unit of PatchVertex::place
  };

  void BindVertices(const StrainDriver& strain, std::span<const std::uint8_t> frames, Entry* entry);
  void BindTriangles(const StrainDriver& strain, const glm::vec3& direction,
                     std::span<const Transform> rest_pose, const JointChains& chains, Entry* entry);
  // Fills one frame per joint of the entry.
  void EvaluatePoints(const Entry& entry, std::span<const Transform> local,
                      const JointChains& chains, std::span<Frame> frames) const;
  void MorphPlaces(const Entry& entry, std::span<const float> blend_shapes,
                   std::span<glm::vec3> places) const;
  // The patch's vertices in the base joint's space.
  void Pose(const Entry& entry, std::span<const Frame> frames, std::span<const float> blend_shapes,
            std::span<glm::vec3> positions) const;
  void ExplainShapes(const Entry& entry, const SolvedPose& pose,
                     DriverExplanation* explanation) const;
  // The mean of F^T F over the patch.
  [[nodiscard]] CauchyGreen MeanTensor(const Entry& entry, std::span<const Frame> frames,
                                       std::span<const float> blend_shapes) const;

  std::vector<Entry> entries_;
  std::vector<int> points_;  // into the binding's JointChains
  std::vector<PatchVertex> vertices_;
  std::vector<PatchTriangle> triangles_;
  std::vector<Shape> shapes_;
  std::vector<std::string> shape_names_;  // of shapes_, as in the rig
  std::vector<Delta> deltas_;
  StrainPlan plan_;
};

}  // namespace furrow::wrinkle
