// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

glm::vec3 NormalizeOr(glm::vec3 v, glm::vec3 fallback) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : fallback;
}

// Splits positions at UV seams: one vertex per combination of position and UV. Normals stay shared.
class SplitMesh {
 public:
  SplitMesh(const MeshSource& source, character::Mesh* mesh) : source_(source), mesh_(*mesh) {}

  std::uint32_t VertexOf(const ObjMesh::Corner& corner) {
    const std::uint64_t key =
        (std::uint64_t{corner.position} << 32) | static_cast<std::uint32_t>(corner.uv);
    const auto [it, added] = index_.emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.push_back(MakeVertex(corner));
    return it->second;
  }

 private:
  character::Vertex MakeVertex(const ObjMesh::Corner& corner) const {
    character::Vertex vertex;
    vertex.position = source_.positions[corner.position];
    vertex.normal = source_.normals[corner.position];
    source_.influences[corner.position].CopyTo(&vertex);
    glm::vec2 uv(0.0f);
    if (corner.uv >= 0) {
      const auto index = static_cast<std::size_t>(corner.uv);
      uv = source_.obj->uvs[index];
      const int move = source_.uv_move.empty() ? -1 : source_.uv_move[index];
      if (move >= 0) uv = source_.uv_moves[static_cast<std::size_t>(move)].Apply(uv);
    }
    // v grows upward in OBJ and downward here.
    vertex.uv = glm::vec2(uv.x, 1.0f - uv.y);
    return vertex;
  }

  const MeshSource& source_;
  character::Mesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

}  // namespace

glm::vec2 UvMove::Apply(glm::vec2 uv) const {
  const glm::vec2 extent = glm::max(from_high - from_low, glm::vec2(1e-9f));
  return to_low + (uv - from_low) / extent * (to_high - to_low);
}

std::vector<glm::vec3> SmoothNormals(const ObjMesh& obj, std::span<const glm::vec3> positions,
                                     std::span<const std::uint32_t> faces) {
  std::vector<glm::vec3> normals(positions.size(), glm::vec3(0.0f));
  for (const std::uint32_t f : faces) {
    const ObjMesh::Face& face = obj.faces[f];
    const auto corner = [&](std::size_t i) {
      return obj.corners[face.first_corner + i % face.num_corners].position;
    };
    for (std::size_t i = 0; i < face.num_corners; ++i) {
      const glm::vec3 here = positions[corner(i)];
      const glm::vec3 to_next = positions[corner(i + 1)] - here;
      const glm::vec3 to_last = positions[corner(i + face.num_corners - 1)] - here;
      const glm::vec3 across = glm::cross(to_next, to_last);
      // Weights by the angle at the corner, so that the normal does not depend on how faces are
      // divided.
      const float angle = std::atan2(glm::length(across), glm::dot(to_next, to_last));
      normals[corner(i)] += NormalizeOr(across, glm::vec3(0.0f)) * angle;
    }
  }
  for (glm::vec3& normal : normals) normal = NormalizeOr(normal, glm::vec3(0.0f, 1.0f, 0.0f));
  return normals;
}

character::Mesh BuildMesh(const std::string& name, int material, const MeshSource& source) {
  character::Mesh mesh;
  mesh.name = name;
  mesh.material = material;
  SplitMesh split(source, &mesh);
  for (const std::uint32_t f : source.faces) {
    const ObjMesh::Face& face = source.obj->faces[f];
    const ObjMesh::Corner* corners = &source.obj->corners[face.first_corner];
    const std::uint32_t first = split.VertexOf(corners[0]);
    for (std::size_t i = 1; i + 1 < face.num_corners; ++i) {
      const std::uint32_t b = split.VertexOf(corners[i]);
      const std::uint32_t c = split.VertexOf(corners[i + 1]);
      if (first == b || b == c || c == first) continue;  // repeated corner
      mesh.indices.insert(mesh.indices.end(), {first, b, c});
    }
  }
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

std::vector<int> UvIslands(const ObjMesh& obj, std::span<const std::uint32_t> faces,
                           int* num_islands) {
  std::vector<std::uint32_t> parent(obj.uvs.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&parent](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<bool> used(obj.uvs.size(), false);
  for (const std::uint32_t f : faces) {
    const ObjMesh::Face& face = obj.faces[f];
    const ObjMesh::Corner* corners = &obj.corners[face.first_corner];
    for (std::size_t i = 0; i < face.num_corners; ++i) {
      if (corners[i].uv < 0) continue;
      used[static_cast<std::size_t>(corners[i].uv)] = true;
      if (corners[0].uv >= 0)
        parent[find(static_cast<std::uint32_t>(corners[i].uv))] =
            find(static_cast<std::uint32_t>(corners[0].uv));
    }
  }
  std::vector<int> island(obj.uvs.size(), -1);
  std::vector<int> number(obj.uvs.size(), -1);
  *num_islands = 0;
  for (std::uint32_t i = 0; i < obj.uvs.size(); ++i) {
    if (!used[i]) continue;
    int& root_number = number[find(i)];
    if (root_number < 0) root_number = (*num_islands)++;
    island[i] = root_number;
  }
  return island;
}

}  // namespace furrow::authoring
