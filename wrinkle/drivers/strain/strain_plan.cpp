// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/strain/strain_plan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

namespace furrow::wrinkle {
namespace {

using Influence = PatchVertex::Influence;

std::span<const Influence> UsedInfluences(const PatchVertex& vertex) {
  const auto* const end = std::ranges::find(vertex.influences, 0.0f, &Influence::skin_weight);
  return {std::begin(vertex.influences), end};
}

// Adds the steps of a row. Rounded sums depend on the order of their terms, so every vertex keeps
// the order of its influences. Each step takes the joint that most vertices wait for.
void AddSteps(std::span<const PatchVertex> vertices, VertexRow* row, std::vector<SkinStep>* steps) {
  std::vector<std::span<const Influence>> left;  // not yet taken, per vertex
  for (const PatchVertex& vertex : vertices) left.push_back(UsedInfluences(vertex));
  row->first_step = static_cast<std::uint32_t>(steps->size());
  for (;;) {
    std::array<int, kMaxPatchJoints + 1> waiting{};
    for (const auto& influences : left) {
      if (!influences.empty()) ++waiting[influences.front().joint];
    }
    const auto most = std::ranges::max_element(waiting);
    if (*most == 0) break;
    SkinStep& step = steps->emplace_back();
    step.joint = static_cast<std::uint32_t>(most - waiting.begin());
    for (std::size_t lane = 0; lane < left.size(); ++lane) {
      if (left[lane].empty() || left[lane].front().joint != step.joint) continue;
      step.skin_weights.at[lane] = left[lane].front().skin_weight;
      left[lane] = left[lane].subspan(1);
    }
  }
  row->num_steps = static_cast<std::uint32_t>(steps->size()) - row->first_step;
}

void AddVertices(std::span<const PatchVertex> vertices, StrainPlan* plan) {
  for (std::size_t first = 0; first < vertices.size(); first += kRowLanes) {
    const auto of_row = vertices.subspan(first, std::min(kRowLanes, vertices.size() - first));
    VertexRow& row = plan->vertices.emplace_back();
    for (std::size_t lane = 0; lane < of_row.size(); ++lane) {
      SetLane(of_row[lane].place, lane, row.place);
    }
    AddSteps(of_row, &row, &plan->steps);
  }
}

// `corners`: the indices of StrainPlan::corners, so far.
void AddTriangles(const BoundPatch& patch, StrainPlan* plan, std::vector<std::uint32_t>* corners) {
  const auto triangles = patch.triangles;
  for (std::size_t first = 0; first < triangles.size(); first += kRowLanes) {
    TriangleRow& row = plan->triangles.emplace_back();
    corners->resize(corners->size() + 3 * kRowLanes);
    std::uint32_t* const indices = &corners->back() + 1 - 3 * kRowLanes;
    for (std::size_t i = first; i < std::min(first + kRowLanes, triangles.size()); ++i) {
      const PatchTriangle& triangle = triangles[i];
      const std::size_t lane = i - first;
      const glm::mat2& m = triangle.rest.inverse_edges;
      SetLane(glm::vec4(m[0], m[1]), lane, row.inverse_edges);
      row.share.at[lane] = triangle.rest.area * patch.inverse_area;
      for (std::size_t k = 0; k < 3; ++k) indices[k * kRowLanes + lane] = triangle.corners[k];
    }
  }
}

// The joints of all patches are planned one after another.
void AddFrames(std::span<const BoundPatch> patches, LanePlanner* planner, StrainPlan* plan) {
  std::vector<std::pair<const int*, std::uint32_t>> frames;  // four points, driver's first value
  for (const BoundPatch& patch : patches) {
    for (std::size_t i = 0; i < patch.points.size(); i += kFramePoints) {
      frames.emplace_back(&patch.points[i], static_cast<std::uint32_t>(patch.first_value));
    }
  }
  // Drivers are in the order of the rig, so the first driver of a block has its lowest value. A
  // level of detail that skips the block needs none of its points.
  for (std::size_t first = 0; first < frames.size(); first += kRowLanes) {
    SinglePoints& block = plan->frames.emplace_back();
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

}  // namespace

StrainPlan PlanStrain(std::span<const BoundPatch> patches, std::size_t num_values,
                      LanePlanner* planner) {
  StrainPlan plan;
  std::vector<std::uint32_t> corners;
  std::uint32_t num_joints = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const BoundPatch& from = patches[i];
    StrainPatch& patch = plan.patches.emplace_back();
    patch.entry = static_cast<int>(i);
    patch.first_value = static_cast<std::uint32_t>(from.first_value);
    patch.num_values = static_cast<std::uint32_t>(num_values);
    patch.first_lane = num_joints;
    patch.num_lanes = static_cast<std::uint32_t>(from.points.size() / kFramePoints);
    num_joints += patch.num_lanes;
    planner->PlaceSingle(&patch);
    patch.first_vertex_row = static_cast<std::uint32_t>(plan.vertices.size());
    patch.num_vertices = static_cast<std::uint32_t>(from.vertices.size());
    AddVertices(from.vertices, &plan);
    patch.first_triangle_row = static_cast<std::uint32_t>(plan.triangles.size());
    patch.num_triangles = static_cast<std::uint32_t>(from.triangles.size());
    AddTriangles(from, &plan, &corners);
  }
  plan.corners = RowGather(corners, 0);
  AddFrames(patches, planner, &plan);
  return plan;
}

}  // namespace furrow::wrinkle
