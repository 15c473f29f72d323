// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_morphs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

// A move of 5 cm at this weight is 5 micrometres long. Trackers report such weights for every shape
// of a resting face, and each would cost as much as a visible one.
constexpr float kMinWeight = 1e-4f;
constexpr float kMaxWeight = 2.0f;

float WeightOf(std::span<const float> shapes, std::size_t shape) {
  return shape < shapes.size() ? DrawnShapeWeight(shapes[shape]) : 0.0f;
}

std::size_t NumParts(const character::Mesh& mesh) {
  std::size_t parts = 1;
  for (const character::MorphTarget& target : mesh.morph_targets) {
    for (const character::MorphDelta& delta : target.deltas) {
      if (delta.tangent != glm::vec3(0.0f)) return 3;
      if (delta.normal != glm::vec3(0.0f)) parts = 2;
    }
  }
  return parts;
}

// The arrays do not overlap. Blocks of constant size become SIMD code at every level of
// optimization; loops of unknown length do not.
void AddScaled(float weight, const float* __restrict from, std::size_t count,
               float* __restrict to) {
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    to[i] += weight * from[i];
    to[i + 1] += weight * from[i + 1];
    to[i + 2] += weight * from[i + 2];
    to[i + 3] += weight * from[i + 3];
  }
  for (; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

float DrawnShapeWeight(float weight) {
  return std::abs(weight) > kMinWeight ? std::clamp(weight, -kMaxWeight, kMaxWeight) : 0.0f;
}

MeshMorphs::MeshMorphs(const character::Mesh& mesh) {
  if (mesh.morph_targets.empty()) return;
  num_parts_ = NumParts(mesh);
  NumberRows(mesh);
  for (const character::MorphTarget& target : mesh.morph_targets) AddTarget(target);
}

// In the order of the vertices, because targets list theirs in this order.
void MeshMorphs::NumberRows(const character::Mesh& mesh) {
  rows_.assign(mesh.vertices.size(), 0);
  for (const character::MorphTarget& target : mesh.morph_targets) {
    for (const character::MorphDelta& delta : target.deltas) rows_[delta.vertex] = 1;
  }
  num_rows_ = 1;
  for (std::uint32_t& row : rows_) {
    if (row != 0) row = static_cast<std::uint32_t>(num_rows_++);
  }
}

void MeshMorphs::AddTarget(const character::MorphTarget& source) {
  Target target;
  target.shape = static_cast<std::size_t>(source.shape);
  target.deltas.reserve(source.deltas.size() * 3 * num_parts_);
  for (const character::MorphDelta& delta : source.deltas) {
    const std::uint32_t row = rows_[delta.vertex];
    if (target.runs.empty() || target.runs.back().row + target.runs.back().num_rows != row) {
      target.runs.push_back({row, 0});
    }
    ++target.runs.back().num_rows;
    target.reach = std::max(target.reach, glm::length(delta.position));
    const glm::vec3 parts[3] = {delta.position, delta.normal, delta.tangent};
    for (std::size_t part = 0; part < num_parts_; ++part) {
      target.deltas.insert(target.deltas.end(), {parts[part].x, parts[part].y, parts[part].z});
    }
  }
  targets_.push_back(std::move(target));
}

std::vector<character::MorphTarget> MeshMorphs::Positions() const {
  std::vector<std::uint32_t> vertex_of(num_rows_, 0);
  for (std::uint32_t vertex = 0; vertex < rows_.size(); ++vertex) {
    if (rows_[vertex] != 0) vertex_of[rows_[vertex]] = vertex;
  }
  std::vector<character::MorphTarget> targets;
  for (const Target& from : targets_) {
    character::MorphTarget& to = targets.emplace_back();
    to.shape = static_cast<int>(from.shape);
    const float* next = from.deltas.data();
    for (const Run& run : from.runs) {
      for (std::uint32_t row = run.row; row < run.row + run.num_rows; ++row) {
        to.deltas.push_back({.vertex = vertex_of[row], .position = {next[0], next[1], next[2]}});
        next += 3 * num_parts_;
      }
    }
  }
  return targets;
}

void MeshMorphs::AppendWeights(std::span<const float> shapes, std::vector<float>* weights) const {
  for (const Target& target : targets_) weights->push_back(WeightOf(shapes, target.shape));
}

bool MeshMorphs::Moves(std::span<const float> shapes) const {
  return std::ranges::any_of(
      targets_, [&](const Target& target) { return WeightOf(shapes, target.shape) != 0.0f; });
}

void MeshMorphs::Sum(std::span<const float> shapes, std::span<float> sums) const {
  const std::size_t row_size = 3 * num_parts_;
  std::fill_n(sums.begin(), num_floats(), 0.0f);
  for (const Target& target : targets_) {
    const float weight = WeightOf(shapes, target.shape);
    if (weight == 0.0f) continue;
    const float* from = target.deltas.data();
    for (const Run& run : target.runs) {
      const std::size_t count = run.num_rows * row_size;
      AddScaled(weight, from, count, &sums[run.row * row_size]);
      from += count;
    }
  }
}

float MeshMorphs::Reach(std::span<const float> shapes) const {
  float reach = 0.0f;
  for (const Target& target : targets_) {
    reach += std::abs(WeightOf(shapes, target.shape)) * target.reach;
  }
  return reach;
}

}  // namespace furrow::render
