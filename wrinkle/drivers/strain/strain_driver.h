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
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// The joints of all patches, sixteen per block, each with the four points of its frame.
struct StrainFrameBlock : SinglePoints {};

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
  static constexpr std::size_t kFramePoints = 4;

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
  // The values of one driver. `frames`: one per joint that moves the patch. `blend_shapes`: the
  // stream's coefficients; missing ones count as 0. `values`: kNumValues.
  void EvaluateFrames(int entry, std::span<const Frame> frames, std::span<const float> blend_shapes,
                      std::span<float> values) const;

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
  [[nodiscard]] const std::vector<StrainFrameBlock>& frame_blocks() const { return frame_blocks_; }
  [[nodiscard]] const std::vector<SingleDriver>& drivers() const { return drivers_; }

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
    Frame resting{1.0f};        // of a joint that does not move relative to the base joint
  };
  struct Influence {
    std::uint8_t joint = 0;  // of the entry's; num_joints: it follows the base joint
    float skin_weight = 0.0f;
  };
  struct Vertex {
    glm::vec3 place{0.0f};  // from the patch's centre, in units of its radius
    Influence influences[StrainDriver::kMaxInfluences];  // unused influences weigh 0
  };
  // A blend shape that moves the entry's vertices.
  struct Shape {
    int blend_shape = 0;  // index into the stream's coefficients
    std::uint32_t first_delta = 0;
    std::uint32_t num_deltas = 0;
  };
  struct Delta {
    std::uint32_t vertex = 0;  // of the entry's
    glm::vec3 move{0.0f};      // at coefficient 1, in the unit of Vertex::place
  };
  struct Triangle {
    std::uint16_t corners[3] = {};  // of the entry's vertices
    RestTriangle rest;
  };

  void BindVertices(const StrainDriver& strain, std::span<const std::uint8_t> frames, Entry* entry);
  void BindTriangles(const StrainDriver& strain, const glm::vec3& direction,
                     std::span<const Transform> rest_pose, const JointChains& chains, Entry* entry);
  // Fills one frame per joint of the entry.
  void EvaluatePoints(const Entry& entry, std::span<const Transform> local,
                      const JointChains& chains, std::span<Frame> frames) const;
  // The patch's vertices, moved by blend shapes alone.
  void Morph(const Entry& entry, std::span<const float> blend_shapes,
             std::span<glm::vec3> places) const;
  // The patch's vertices in the base joint's space.
  void Pose(const Entry& entry, std::span<const Frame> frames, std::span<const float> blend_shapes,
            std::span<glm::vec3> positions) const;
  void ExplainShapes(const Entry& entry, const SolvedPose& pose,
                     DriverExplanation* explanation) const;
  [[nodiscard]] Measured MeasureFrames(const Entry& entry, std::span<const Frame> frames,
                                       std::span<const float> blend_shapes) const;

  std::vector<Entry> entries_;
  std::vector<int> points_;  // into the binding's JointChains
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Shape> shapes_;
  std::vector<std::string> shape_names_;  // of shapes_, as in the rig
  std::vector<Delta> deltas_;
  std::vector<StrainFrameBlock> frame_blocks_;
  std::vector<SingleDriver> drivers_;
};

}  // namespace furrow::wrinkle
