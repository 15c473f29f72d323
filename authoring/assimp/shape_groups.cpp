// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/shape_groups.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "authoring/assimp/assimp_materials.h"
#include "authoring/assimp/scene_file.h"
#include "base/text.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxInBetweens = 9;

std::vector<glm::vec3> DeltasOf(const aiAnimMesh& shape, const aiMesh& mesh) {
  std::vector<glm::vec3> deltas;
  deltas.reserve(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    deltas.push_back(ToGlm(shape.mVertices[v]) - ToGlm(mesh.mVertices[v]));
  return deltas;
}

// The sum of the squared distances by which a shape moves the vertices.
double ExtentOf(const aiAnimMesh& shape, const aiMesh& mesh) {
  double sum = 0.0;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    sum += static_cast<double>((shape.mVertices[v] - mesh.mVertices[v]).SquareLength());
  return std::isfinite(sum) ? sum : 0.0;
}

bool EndsWithDigit(std::string_view name) {
  return !name.empty() && name.back() >= '0' && name.back() <= '9';
}

}  // namespace

std::vector<ShapeGroup> GroupShapes(const aiMesh& mesh) {
  std::vector<ShapeGroup> groups;
  for (unsigned s = 0; s < mesh.mNumAnimMeshes; ++s) {
    const aiAnimMesh& shape = *mesh.mAnimMeshes[s];
    const std::string name = shape.mName.C_Str();
    if (name.empty() || groups.empty() || groups.back().name != name) groups.push_back({name, {}});
    const bool complete = shape.mVertices != nullptr && shape.mNumVertices == mesh.mNumVertices;
    if (complete) groups.back().shapes.push_back(&shape);
  }
  for (ShapeGroup& group : groups) {
    if (group.shapes.size() < 2) continue;
    std::ranges::stable_sort(group.shapes, {},
                             [&](const aiAnimMesh* shape) { return ExtentOf(*shape, mesh); });
  }
  return groups;
}

std::vector<NamedDeltas> TargetsOf(const ShapeGroup& group, const aiMesh& mesh,
                                   std::vector<std::string>* remarks) {
  if (group.shapes.empty()) return {};
  aiString text;
  text.Set(group.name);
  const std::string name = NameFrom(text);
  std::vector<NamedDeltas> targets = {{name, DeltasOf(*group.shapes.back(), mesh)}};
  const std::size_t in_betweens = group.shapes.size() - 1;
  if (in_betweens == 0) return targets;
  const std::string where = "blend shape '" + name + "' has " + Counted(in_betweens, "in-between");
  if (name.empty() || EndsWithDigit(name) || in_betweens > kMaxInBetweens) {
    remarks->push_back(where + ", left out");
    return targets;
  }
  std::string percents;
  for (std::size_t i = 0; i < in_betweens; ++i) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(in_betweens + 1);
    const auto percent = static_cast<int>(std::lround(100.0 * share));
    NamedDeltas target{name + std::to_string(percent), DeltasOf(*group.shapes[i], mesh)};
    const float reached = 0.01f * static_cast<float>(percent);
    for (std::size_t v = 0; v < target.deltas.size(); ++v)
      target.deltas[v] -= reached * targets.front().deltas[v];
    percents += (i > 0 ? ", " : "") + std::to_string(percent);
    targets.push_back(std::move(target));
  }
  remarks->push_back(where + "; the weights in the file are unknown, and " + percents +
                     " % are used");
  return targets;
}

}  // namespace furrow::authoring
