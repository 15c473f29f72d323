// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/import/makehuman/obj.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "character/character.h"

namespace furrow::authoring {

// A rectangle of UV space (v up, as in .obj) and where it goes; a whole UV island moves at once.
struct UvMove {
  glm::vec2 from_low{0.0f};
  glm::vec2 from_high{1.0f};
  glm::vec2 to_low{0.0f};
  glm::vec2 to_high{1.0f};

  [[nodiscard]] glm::vec2 Apply(glm::vec2 uv) const;
};

// What BuildMesh() makes a mesh of. Spans are indexed as `obj`'s positions are.
struct MeshSource {
  const ObjMesh* obj = nullptr;
  std::span<const glm::vec3> positions;  // metres, model space
  std::span<const glm::vec3> normals;    // unit; see SmoothNormals()
  std::span<const Influences> influences;
  std::vector<std::uint32_t> faces;  // into obj->faces: the ones to draw
  std::vector<int> uv_move;          // by obj uv: index into uv_moves; empty: UVs stay
  std::vector<UvMove> uv_moves;
};

// Smooth normals, weighted by the corners' angles, from `faces` of the mesh: computed before
// vertices are split, so that UV seams do not show, and from hidden faces too, so that borders do
// not bend.
[[nodiscard]] std::vector<glm::vec3> SmoothNormals(const ObjMesh& obj,
                                                   std::span<const glm::vec3> positions,
                                                   std::span<const std::uint32_t> faces);

// Triangles with one vertex for each (position, UV) in use, tangents from the UVs (glTF's
// convention: the bitangent points up the picture), v turned down.
[[nodiscard]] character::Mesh BuildMesh(const std::string& name, int material,
                                        const MeshSource& source);

// Connected pieces of UV space among `faces`: by obj uv, the index of its island; -1 where unused.
[[nodiscard]] std::vector<int> UvIslands(const ObjMesh& obj, std::span<const std::uint32_t> faces,
                                         int* num_islands);

}  // namespace furrow::authoring
