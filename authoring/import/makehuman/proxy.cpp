// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/proxy.h"

#include <utility>

#include <glm/geometric.hpp>

#include "authoring/import/makehuman/mesh_builder.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "base/files.h"

namespace furrow::authoring {
namespace {

bool IsHidden(const Mhclo::GarmentVertex& vertex, const std::vector<bool>& hidden) {
  if (vertex.weights[1] == 0.0f && vertex.weights[2] == 0.0f) return hidden[vertex.base[0]];
  int count = 0;
  for (const std::uint32_t base : vertex.base) count += hidden[base] ? 1 : 0;
  return count >= 2;
}

// The faces that are drawn.
std::vector<std::uint32_t> VisibleFaces(const Proxy& proxy, const std::vector<bool>& hidden) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < proxy.obj.faces.size(); ++f) {
    const ObjMesh::Face& face = proxy.obj.faces[f];
    bool visible = hidden.empty();
    for (std::size_t i = 0; !visible && i < face.num_corners; ++i) {
      const std::uint32_t vertex = proxy.obj.corners[face.first_corner + i].position;
      visible = !IsHidden(proxy.fit.vertices[vertex], hidden);
    }
    if (visible) faces.push_back(f);
  }
  return faces;
}

}  // namespace

Result<Proxy> ReadProxy(const std::filesystem::path& mhclo, std::size_t num_base_vertices) {
  const Result<std::string> text = ReadFile(mhclo, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  Result<Mhclo> fit = ParseMhclo(*text, mhclo.string(), num_base_vertices);
  FURROW_RETURN_IF_ERROR(fit);
  const std::filesystem::path obj_path = mhclo.parent_path() / fit->obj_file;
  const Result<std::string> obj_text = ReadFile(obj_path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(obj_text);
  Result<ObjMesh> obj = ParseObj(*obj_text, obj_path.string());
  FURROW_RETURN_IF_ERROR(obj);
  if (obj->positions.size() != fit->vertices.size())
    return Status(StatusCode::kSchema,
                  "lists " + std::to_string(fit->vertices.size()) + " vertices, but " +
                      fit->obj_file + " has " + std::to_string(obj->positions.size()),
                  mhclo.string());
  return Proxy{mhclo, std::move(*fit), std::move(*obj)};
}

Result<FittedProxy> FitProxy(const Proxy& proxy, const BaseMesh& base, const std::string& name,
                             const std::vector<bool>& hidden) {
  const std::vector<glm::vec3> positions = FitGarment(proxy.fit, base.positions);
  for (const glm::vec3& p : positions) {
    // Finite factors and offsets may still multiply to anything. The comparison is false for NaN.
    constexpr float kFar = 100.0f;  // metres
    if (!(glm::length(p) < kFar))
      return Status(StatusCode::kInvalidArgument,
                    "the garment '" + proxy.fit.name + "' is 100 m or more away from the body",
                    proxy.fit.obj_file, "check the scales and offsets in its .mhclo file");
  }
  const SkinWeights skin = BindGarment(proxy.fit, base.skin);
  std::vector<std::uint32_t> faces(proxy.obj.faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) faces[f] = f;
  const std::vector<glm::vec3> normals = SmoothNormals(proxy.obj, positions, faces);
  MeshSource source;
  source.obj = &proxy.obj;
  source.positions = positions;
  source.normals = normals;
  source.influences = skin.vertices;
  source.faces = VisibleFaces(proxy, hidden);
  FittedProxy fitted;
  fitted.hidden_faces = static_cast<int>(faces.size() - source.faces.size());
  fitted.mesh = BuildMesh(name, -1, source);
  fitted.unweighted = skin.unweighted;
  fitted.truncated = skin.truncated;
  return fitted;
}

}  // namespace furrow::authoring
