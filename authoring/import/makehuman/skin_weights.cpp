// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/skin_weights.h"

#include <algorithm>
#include <string>

namespace furrow::character {
namespace {

using JointWeight = std::pair<std::uint16_t, float>;

// Keeps the four strongest of `all` (one entry a joint) and normalises them. False: nothing to
// keep.
bool Pack(std::vector<JointWeight>* all, Influences* out, int* truncated) {
  std::sort(all->begin(), all->end(), [](const JointWeight& a, const JointWeight& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  while (!all->empty() && !(all->back().second > 0.0f)) all->pop_back();
  if (all->size() > 4) {
    ++*truncated;
    all->resize(4);
  }
  float sum = 0.0f;
  for (const JointWeight& entry : *all) sum += entry.second;
  if (!(sum > 0.0f)) return false;
  *out = Influences();
  for (std::size_t i = 0; i < all->size(); ++i) {
    out->joints[i] = (*all)[i].first;
    out->weights[i] = (*all)[i].second / sum;
  }
  return true;
}

void Add(std::vector<JointWeight>* all, std::uint16_t joint, float weight) {
  const auto it = std::find_if(all->begin(), all->end(),
                               [joint](const JointWeight& entry) { return entry.first == joint; });
  if (it == all->end()) {
    all->emplace_back(joint, weight);
  } else {
    it->second += weight;
  }
}

}  // namespace

Result<SkinWeights> BindBaseMesh(const MhWeights& weights, const wrinkle::Skeleton& skeleton,
                                 std::size_t num_vertices, std::string_view source) {
  std::vector<std::vector<JointWeight>> by_vertex(num_vertices);
  for (const MhWeights::Joint& joint : weights.joints) {
    const int index = skeleton.Find(joint.name);
    if (index == wrinkle::kNoJoint)
      return Status(StatusCode::kNotFound, "the skeleton has no such joint",
                    std::string(source) + ": weights." + joint.name);
    for (const auto& [vertex, weight] : joint.vertices) {
      if (vertex >= num_vertices)
        return Status(StatusCode::kInvalidArgument,
                      "vertex " + std::to_string(vertex) + " is out of range (the mesh has " +
                          std::to_string(num_vertices) + ")",
                      std::string(source) + ": weights." + joint.name);
      Add(&by_vertex[vertex], static_cast<std::uint16_t>(index), weight);
    }
  }
  SkinWeights skin;
  skin.vertices.resize(num_vertices);
  for (std::size_t v = 0; v < num_vertices; ++v) {
    if (!Pack(&by_vertex[v], &skin.vertices[v], &skin.truncated)) ++skin.unweighted;
  }
  return skin;
}

SkinWeights BindGarment(const Mhclo& garment, const SkinWeights& base) {
  SkinWeights skin;
  skin.vertices.resize(garment.vertices.size());
  std::vector<JointWeight> all;
  for (std::size_t v = 0; v < garment.vertices.size(); ++v) {
    const Mhclo::Vertex& vertex = garment.vertices[v];
    all.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      const Influences& influences = base.vertices[vertex.base[i]];
      for (std::size_t k = 0; k < 4; ++k) {
        const float weight = influences.weights[k] * std::max(0.0f, vertex.weights[i]);
        if (weight > 0.0f) Add(&all, influences.joints[k], weight);
      }
    }
    if (!Pack(&all, &skin.vertices[v], &skin.truncated)) ++skin.unweighted;
  }
  return skin;
}

}  // namespace furrow::character
