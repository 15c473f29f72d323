// SPDX-License-Identifier: Apache-2.0
// Evaluates strain drivers. The frames of the joints (four points each) are computed one joint per
// SIMD lane. Each patch then has one vertex per lane and one triangle per lane: few drivers are
// strain drivers, and patches differ in size. All results have the bits of
// StrainDriverSet::EvaluateFrames().
#if defined(FURROW_WRINKLE_STRAIN_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_STRAIN_LANES_INL_H_
#undef FURROW_WRINKLE_STRAIN_LANES_INL_H_
#else
#define FURROW_WRINKLE_STRAIN_LANES_INL_H_
#endif

#include <array>
#include <cstddef>
#include <span>

#include "wrinkle/drivers/strain/strain_driver.h"
#include "wrinkle/simd/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Three numbers of each of up to kCount vertices or triangles, in lanes. Not initialised, because
// only the rows in use are written and read.
template <std::size_t kCount>
struct PatchNumbers {
  alignas(kRowAlignment) float x[kCount];
  alignas(kRowAlignment) float y[kCount];
  alignas(kRowAlignment) float z[kCount];

  [[nodiscard]] HWY_INLINE Float3 Load(std::size_t i) const {
    return {LoadLanes(x + i), LoadLanes(y + i), LoadLanes(z + i)};
  }
  HWY_INLINE void Store(Float3 v, std::size_t i) {
    StoreLanes(v.x, x + i);
    StoreLanes(v.y, y + i);
    StoreLanes(v.z, z + i);
  }
};
using VertexNumbers = PatchNumbers<kMaxPatchVertices>;
using TriangleNumbers = PatchNumbers<kMaxPatchTriangles>;
static_assert(kMaxPatchVertices % kRowLanes == 0 && kMaxPatchTriangles % kRowLanes == 0);

// The frames of a patch's joints, and last that of a joint that rests.
using PatchFrames = std::array<StrainDriverSet::Frame, kMaxPatchJoints + 1>;

// From the rows that the points of the frames were stored to.
inline void LoadFrames(const StrainDriverSet& drivers, const StrainPatch& patch, const float* rows,
                       PatchFrames* frames) {
  for (std::size_t i = 0; i < patch.num_lanes; ++i) {
    const std::size_t lane = patch.first_lane + i;
    const SinglePoints& block = drivers.plan().frames[lane / kRowLanes];
    std::array<glm::vec3, kFramePoints> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = StoredPoint(block, lane % kRowLanes, k, rows);
    }
    (*frames)[i] = StrainDriverSet::MakeFrame(points);
  }
  (*frames)[patch.num_lanes] = drivers.resting(patch.entry);
}

// glm's mat4x3 * vec4(place, 1).
HWY_INLINE Float3 MovePlace(const StrainDriverSet::Frame& frame, Float3 place) {
  const auto coordinate = [&](int i) HWY_ATTR {
    const Float xy =
        hn::Add(hn::Mul(Splat(frame[0][i]), place.x), hn::Mul(Splat(frame[1][i]), place.y));
    return hn::Add(hn::Add(xy, hn::Mul(Splat(frame[2][i]), place.z)), Splat(frame[3][i]));
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

// The position of each vertex: the sum of its influences.
HWY_INLINE Float3 SkinVertices(std::span<const SkinStep> steps, const PatchFrames& frames,
                               Float3 place, std::size_t lane) {
  const Float zero = hn::Zero(Floats());
  Float3 position{zero, zero, zero};
  for (const SkinStep& step : steps) {
    const Float skin_weight = LoadRow(step.skin_weights, lane);
    const Float3 sum = position + skin_weight * MovePlace(frames[step.joint], place);
    // A frame that is not finite affects only the vertices that follow it.
    position = IfThenElse(hn::Ne(skin_weight, zero), sum, position);
  }
  return position;
}

// Writes the position of each vertex of a patch.
inline void PoseVertices(const StrainDriverSet& drivers, const StrainPatch& patch,
                         std::span<const float> blend_shapes, const PatchFrames& frames,
                         VertexNumbers* positions) {
  const StrainPlan& plan = drivers.plan();
  const bool morphs = drivers.has_shapes(patch.entry);
  if (morphs) {
    std::array<glm::vec3, kMaxPatchVertices> places;
    drivers.Morph(patch.entry, blend_shapes, places);
    for (std::size_t i = 0; i < patch.num_vertices; ++i) {
      positions->x[i] = places[i].x;
      positions->y[i] = places[i].y;
      positions->z[i] = places[i].z;
    }
  }
  for (std::size_t i = 0; i < patch.num_vertices; i += kLanes) {
    const VertexRow& row = plan.vertices[patch.first_vertex_row + i / kRowLanes];
    const std::size_t lane = i % kRowLanes;
    const std::span<const SkinStep> steps(plan.steps.data() + row.first_step, row.num_steps);
    const Float3 place = morphs ? positions->Load(i) : LoadRows(row.place, lane);
    positions->Store(SkinVertices(steps, frames, place, lane), i);
  }
}

// Writes F^T F of each triangle (xx, xy, yy), times its share of the patch.
inline void DeformTriangles(const StrainPlan& plan, const StrainPatch& patch,
                            const VertexNumbers& positions, TriangleNumbers* tensors) {
  const Gatherer gatherer(plan.corners);
  for (std::size_t i = 0; i < patch.num_triangles; i += kLanes) {
    const std::size_t row = patch.first_triangle_row + i / kRowLanes;
    const std::size_t lane = i % kRowLanes;
    const auto corner = [&](std::size_t k) HWY_ATTR {
      return Float3{gatherer.Row(3 * row + k, lane, positions.x),
                    gatherer.Row(3 * row + k, lane, positions.y),
                    gatherer.Row(3 * row + k, lane, positions.z)};
    };
    const TriangleRow& triangles = plan.triangles[row];
    const Float3 a = corner(0);
    const Float3 u = corner(1) - a;
    const Float3 v = corner(2) - a;
    const FloatRow* const m = triangles.inverse_edges;
    const Float3 x = LoadRow(m[0], lane) * u + LoadRow(m[1], lane) * v;
    const Float3 y = LoadRow(m[2], lane) * u + LoadRow(m[3], lane) * v;
    tensors->Store(LoadRow(triangles.share, lane) * Float3{Dot(x, x), Dot(x, y), Dot(y, y)}, i);
  }
}

// Writes the values of one driver to `rows` from patch.first_number on, one after another. The
// points of its frames are in `rows` already.
inline void EvaluatePatch(const StrainDriverSet& drivers, const StrainPatch& patch,
                          std::span<const float> blend_shapes, float* rows) {
  PatchFrames frames;
  VertexNumbers positions;
  TriangleNumbers tensors;
  LoadFrames(drivers, patch, rows, &frames);
  PoseVertices(drivers, patch, blend_shapes, frames, &positions);
  DeformTriangles(drivers.plan(), patch, positions, &tensors);
  // One after another: rounded sums depend on the order of their terms.
  CauchyGreen mean{0.0f, 0.0f, 0.0f};
  for (std::size_t i = 0; i < patch.num_triangles; ++i) {
    mean.xx += tensors.x[i];
    mean.xy += tensors.y[i];
    mean.yy += tensors.z[i];
  }
  drivers.WriteValues(patch.entry, mean, {rows + patch.first_number, patch.num_values});
}

// Writes the values of each driver of `drivers` to the scratch memory `rows` (kRowLanes floats per
// row), four consecutive floats per driver: along, across, diagonal_left and diagonal_right.
template <bool kScaled>
void EvaluateDrivers(const StrainDriverSet& drivers, const PointPlan& plan, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  // Twelve rows per block: x, y and z of each of the four points.
  const auto evaluate = [&](const SinglePoints& block, std::size_t lane, float* to) HWY_ATTR {
    const FourPoints four = EvaluateFour(plan, &plan.points[block.first_point], pose, lane);
    for (const Float3& point : four.at) {
      StoreRows(point, to);
      to += 3 * kRowLanes;
    }
  };
  ForEachBlock(drivers.plan().frames, input.num_values, rows, evaluate);
  for (const StrainPatch& patch : drivers.plan().patches) {
    if (patch.first_value < input.num_values) {
      EvaluatePatch(drivers, patch, input.blend_shapes, rows);
    }
  }
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
