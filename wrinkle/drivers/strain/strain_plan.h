// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wrinkle/drivers/strain/strain.h"
#include "wrinkle/drivers/strain/strain_fields.h"
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

// Bound strain drivers laid out in lanes; strain_lanes-inl.h reads the tables. Private to wrinkle/.

// The points of a joint's frame (StrainDriverSet).
inline constexpr std::size_t kFramePoints = 4;

// A vertex of a bound patch.
struct PatchVertex {
  struct Influence {
    std::uint8_t joint = 0;  // of the driver's; the number of joints: it follows the base joint
    float skin_weight = 0.0f;
  };
  glm::vec3 place{0.0f};  // from the patch's centre, in units of its radius
  Influence influences[StrainDriver::kMaxInfluences];  // unused influences weigh 0
};

// A triangle of a bound patch.
struct PatchTriangle {
  std::uint16_t corners[3] = {};  // of the patch's vertices
  RestTriangle rest;
};

// What the planner needs of one bound driver.
struct BoundPatch {
  int first_value = 0;
  std::span<const int> points;  // kFramePoints per joint, into the binding's JointChains
  std::span<const PatchVertex> vertices;
  std::span<const PatchTriangle> triangles;
  float inverse_area = 0.0f;  // of all triangles
};

// One influence of each of sixteen vertices, all by the same joint.
struct SkinStep {
  FloatRow skin_weights;    // 0 in lanes without this influence
  std::uint32_t joint = 0;  // PatchVertex::Influence::joint
};

// Sixteen vertices of a patch.
struct VertexRow {
  FloatRow place[3];
  std::uint32_t first_step = 0;  // into StrainPlan::steps
  std::uint32_t num_steps = 0;
};

// Sixteen triangles of a patch.
struct TriangleRow {
  FloatRow inverse_edges[4];  // column by column
  FloatRow share;             // of the patch's area
};

// A driver. Its vertices and triangles are evaluated side by side.
struct StrainPatch : SingleDriver {
  std::uint32_t first_vertex_row = 0;  // into StrainPlan::vertices
  std::uint32_t num_vertices = 0;
  std::uint32_t first_triangle_row = 0;  // into StrainPlan::triangles
  std::uint32_t num_triangles = 0;
};

struct StrainPlan {
  // The joints of all patches, sixteen per block. A block has twelve rows: x, y and z of each of a
  // joint's points.
  std::vector<SinglePoints> frames;
  std::vector<StrainPatch> patches;
  std::vector<VertexRow> vertices;
  std::vector<SkinStep> steps;
  std::vector<TriangleRow> triangles;
  RowGather corners;  // out of one coordinate of a patch's vertices: three rows per TriangleRow
};

[[nodiscard]] StrainPlan PlanStrain(std::span<const BoundPatch> patches, std::size_t num_values,
                                    LanePlanner* planner);

}  // namespace furrow::wrinkle
