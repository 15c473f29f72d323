// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/skin_weights.h"

#include <algorithm>
#include <string>

#include "base/text.h"

namespace furrow::authoring {
namespace {

// False if the vertex has no weight at all.
bool Store(const InfluenceSum& sum, Influences* out, int* truncated) {
  if (sum.num_joints() == 0) return false;
  if (sum.num_joints() > 4) ++*truncated;
  *out = sum.Strongest();
  return true;
}

}  // namespace

Result<SkinWeights> BindBaseMesh(const MhWeights& weights, const wrinkle::Skeleton& skeleton,
                                 std::size_t num_vertices, std::string_view source) {
  std::vector<InfluenceSum> by_vertex(num_vertices);
  for (const MhWeights::Joint& joint : weights.joints) {
    const int index = skeleton.Find(joint.name);
    if (index == wrinkle::kNoJoint)
      return Status(StatusCode::kNotFound, "the skeleton has no joint " + Quoted(joint.name),
                    std::string(source) + ": weights." + joint.name);
    for (const auto& [vertex, weight] : joint.vertices) {
      if (vertex >= num_vertices)
        return Status(StatusCode::kInvalidArgument,
                      "vertex index " + std::to_string(vertex) + " is out of range; the mesh has " +
                          Counted(num_vertices, "vertex", "vertices"),
                      std::string(source) + ": weights." + joint.name);
      by_vertex[vertex].Add(static_cast<std::uint16_t>(index), weight);
    }
  }
  SkinWeights skin;
  skin.vertices.resize(num_vertices);
  for (std::size_t v = 0; v < num_vertices; ++v) {
    if (!Store(by_vertex[v], &skin.vertices[v], &skin.truncated)) ++skin.unweighted;
  }
  return skin;
}

SkinWeights BindGarment(const Mhclo& garment, const SkinWeights& base) {
  SkinWeights skin;
  skin.vertices.resize(garment.vertices.size());
  for (std::size_t v = 0; v < garment.vertices.size(); ++v) {
    const Mhclo::GarmentVertex& vertex = garment.vertices[v];
    InfluenceSum sum;
    for (std::size_t i = 0; i < 3; ++i) {
      sum.Add(base.vertices[vertex.base[i]], std::max(0.0f, vertex.weights[i]));
    }
    if (!Store(sum, &skin.vertices[v], &skin.truncated)) ++skin.unweighted;
  }
  return skin;
}

}  // namespace furrow::authoring
