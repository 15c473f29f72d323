// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/body_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "authoring/import/makehuman/face/prop_paint.h"
#include "authoring/paint/teeth.h"
#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

// The layout of the UV islands: the face on the left, all others in a strip on the right. The gap
// keeps dilation and mip levels apart.
constexpr float kFaceRight = 0.74f;
constexpr float kRestLeft = 0.76f;
constexpr float kMargin = 0.004f;

struct Island {
  glm::vec2 low{std::numeric_limits<float>::max()};
  glm::vec2 high{std::numeric_limits<float>::lowest()};
  int head_faces = 0;
};

std::vector<Island> DescribeIslands(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                                    std::span<const std::uint32_t> faces,
                                    const std::vector<int>& island_of_uv, int num_islands) {
  std::vector<Island> islands(static_cast<std::size_t>(num_islands));
  const int head = skeleton.Find("head");
  for (const std::uint32_t f : faces) {
    const ObjMesh::Face& face = base.obj.faces[f];
    for (std::size_t i = 0; i < face.num_corners; ++i) {
      const ObjMesh::Corner& corner = base.obj.corners[face.first_corner + i];
      if (corner.uv < 0) continue;
      const auto uv = static_cast<std::size_t>(corner.uv);
      Island& island = islands[static_cast<std::size_t>(island_of_uv[uv])];
      island.low = glm::min(island.low, base.obj.uvs[uv]);
      island.high = glm::max(island.high, base.obj.uvs[uv]);
      const int joint = base.skin.vertices[corner.position].joints[0];
      if (i == 0 && head != wrinkle::kNoJoint && skeleton.IsAncestor(head, joint))
        ++island.head_faces;
    }
  }
  return islands;
}

// Sets the moves of `source`: [0] for the face's island, [1] for all others.
void ArrangeIslands(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                    std::span<const std::uint32_t> faces, MeshSource* source) {
  int num_islands = 0;
  const std::vector<int> island_of_uv = UvIslands(base.obj, faces, &num_islands);
  if (num_islands == 0) return;
  const std::vector<Island> islands =
      DescribeIslands(base, skeleton, faces, island_of_uv, num_islands);
  // The island with the most faces that move with the head. It gets most of the picture.
  const auto face = std::max_element(
      islands.begin(), islands.end(),
      [](const Island& a, const Island& b) { return a.head_faces < b.head_faces; });
  Island rest;
  for (auto it = islands.begin(); it != islands.end(); ++it) {
    if (it == face) continue;
    rest.low = glm::min(rest.low, it->low);
    rest.high = glm::max(rest.high, it->high);
  }
  source->uv_moves = {
      {face->low, face->high, {kMargin, kMargin}, {kFaceRight, 1.0f - kMargin}},
      {rest.low, rest.high, {kRestLeft, kMargin}, {1.0f - kMargin, 1.0f - kMargin}}};
  const int face_index = static_cast<int>(face - islands.begin());
  source->uv_move.assign(island_of_uv.size(), -1);
  for (std::size_t i = 0; i < island_of_uv.size(); ++i) {
    if (island_of_uv[i] >= 0) source->uv_move[i] = island_of_uv[i] == face_index ? 0 : 1;
  }
}

// A face at the border of a garment has corners that stay visible, so it is kept.
bool AllDeleted(const ObjMesh& obj, const ObjMesh::Face& face, const std::vector<bool>& deleted) {
  for (std::size_t i = 0; i < face.num_corners; ++i) {
    if (!deleted[obj.corners[face.first_corner + i].position]) return false;
  }
  return true;
}

// The bounding box of a group's vertices in front of `z`, and one of the vertices. Empty: low >
// high.
struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};
  std::uint32_t vertex = 0;
};

Bounds BoundsOf(const BaseMesh& base, std::string_view group,
                float z = std::numeric_limits<float>::lowest()) {
  Bounds bounds;
  for (const std::uint32_t f : FacesOf(base.obj, group)) {
    const ObjMesh::Face& face = base.obj.faces[f];
    for (std::size_t i = 0; i < face.num_corners; ++i) {
      const std::uint32_t vertex = base.obj.corners[face.first_corner + i].position;
      const glm::vec3& p = base.positions[vertex];
      if (p.z < z) continue;
      bounds.vertex = vertex;
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  return bounds;
}

// Completes `forward` to a right-handed frame of unit vectors: right (of the picture) and up.
void PictureAxes(const glm::vec3& forward, glm::vec3* right, glm::vec3* up) {
  const glm::vec3 above =
      std::abs(forward.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  *right = glm::normalize(glm::cross(above, forward));
  *up = glm::cross(forward, *right);
}

}  // namespace

std::vector<std::uint32_t> FacesOf(const ObjMesh& obj, std::string_view group) {
  std::vector<std::uint32_t> faces;
  const int index = obj.FindGroup(group);
  for (std::uint32_t f = 0; f < obj.faces.size(); ++f) {
    if (obj.faces[f].group == index) faces.push_back(f);
  }
  return faces;
}

character::Mesh BuildSkin(const BaseMesh& base, const wrinkle::Skeleton& skeleton,
                          const std::vector<bool>& deleted, int material, int* hidden_faces,
                          std::vector<UvMove>* uv_moves) {
  const std::vector<std::uint32_t> faces = FacesOf(base.obj, "body");
  const std::vector<glm::vec3> normals = SmoothNormals(base.obj, base.positions, faces);
  MeshSource source;
  source.obj = &base.obj;
  source.positions = base.positions;
  source.normals = normals;
  source.influences = base.skin.vertices;
  for (const std::uint32_t f : faces) {
    if (!deleted.empty() && AllDeleted(base.obj, base.obj.faces[f], deleted)) continue;
    source.faces.push_back(f);
  }
  *hidden_faces = static_cast<int>(faces.size() - source.faces.size());
  ArrangeIslands(base, skeleton, source.faces, &source);
  if (uv_moves != nullptr) *uv_moves = source.uv_moves;
  return BuildMesh("skin", material, source);
}

character::Mesh BuildHelper(const BaseMesh& base, std::string_view group, int material) {
  MeshSource source;
  source.faces = FacesOf(base.obj, group);
  const std::vector<glm::vec3> normals = SmoothNormals(base.obj, base.positions, source.faces);
  source.obj = &base.obj;
  source.positions = base.positions;
  source.normals = normals;
  source.influences = base.skin.vertices;
  return BuildMesh(std::string(group), material, source);
}

character::Mesh BuildTeeth(const BaseMesh& base, std::string_view group, bool upper, int material) {
  character::Mesh mesh;
  mesh.name = std::string(group);
  mesh.material = material;
  const Bounds box = BoundsOf(base, group);
  if (box.low.x > box.high.x) return mesh;
  constexpr float kCentimetres = 100.0f;
  constexpr float kFront = 0.007f;  // depth of the incisors behind the foremost point, metres
  // Only the front teeth give the height of the biting edge; molars may be higher or lower.
  const Bounds incisors = BoundsOf(base, group, box.high.z - kFront);
  const glm::vec3 front(0.5f * (box.low.x + box.high.x), upper ? incisors.low.y : incisors.high.y,
                        box.high.z);
  const glm::vec3 size = kCentimetres * (box.high - box.low);
  const ToothArch arch{upper, kCentimetres * front, 0.5f * size.x, size.z, 0.2f * size.z};
  const ToothRow row = MakeToothRow(arch);
  const Influences& held = base.skin.vertices[box.vertex];
  for (std::size_t i = 0; i < row.positions.size(); ++i) {
    character::Vertex vertex;
    vertex.position = row.positions[i] / kCentimetres;
    vertex.uv = row.uvs[i];
    held.CopyTo(&vertex);
    mesh.vertices.push_back(vertex);
  }
  for (std::size_t i = 0; i < row.quads.size(); i += 4) {
    const std::uint32_t* quad = &row.quads[i];
    mesh.indices.insert(mesh.indices.end(), {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
  }
  character::paint::ComputeNormals(mesh.vertices, mesh.indices);
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

character::Mesh BuildEye(const BaseMesh& base, std::string_view group, int joint,
                         const glm::vec3& forward, int material) {
  constexpr int kRings = 24;
  constexpr int kSegments = 36;
  constexpr float kCorneaAngle = 0.6f;   // radians from the axis
  constexpr float kCorneaBulge = 0.06f;  // fraction of the radius
  const Bounds box = BoundsOf(base, group);
  character::Mesh mesh;
  mesh.name = std::string(group);
  mesh.material = material;
  if (box.low.x > box.high.x) return mesh;
  const glm::vec3 centre = 0.5f * (box.low + box.high);
  const float radius = 0.25f * (box.high.x - box.low.x + box.high.y - box.low.y);
  glm::vec3 right, up;
  PictureAxes(forward, &right, &up);
  for (int ring = 0; ring <= kRings; ++ring) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(ring) / kRings;
    const float dome = std::clamp(1.0f - angle / kCorneaAngle, 0.0f, 1.0f);
    const float reach = radius * (1.0f + kCorneaBulge * dome * dome * (3.0f - 2.0f * dome));
    for (int segment = 0; segment <= kSegments; ++segment) {
      const float turn = 2.0f * std::numbers::pi_v<float> * static_cast<float>(segment) / kSegments;
      const glm::vec2 spoke(std::cos(turn), std::sin(turn));
      character::Vertex vertex;
      vertex.normal =
          forward * std::cos(angle) + (right * spoke.x + up * spoke.y) * std::sin(angle);
      vertex.position = centre + vertex.normal * reach;
      const glm::vec2 uv = spoke * std::min(angle / kEyePictureAngle, 1.0f) * 0.5f;
      vertex.uv = glm::vec2(0.5f + uv.x, 0.5f - uv.y);
      vertex.joints[0] = static_cast<std::uint16_t>(joint);
      mesh.vertices.push_back(vertex);
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const auto a = static_cast<std::uint32_t>(ring * (kSegments + 1) + segment);
      const std::uint32_t below = a + kSegments + 1;
      // At each pole one triangle of the quad has no area.
      if (ring + 1 < kRings) mesh.indices.insert(mesh.indices.end(), {a, below, below + 1});
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, below + 1, a + 1});
    }
  }
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

}  // namespace furrow::authoring
