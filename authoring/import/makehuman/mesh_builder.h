// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/import/makehuman/formats/obj.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "character/character.h"

namespace furrow::authoring {

// Moves a UV island: maps one rectangle of UV space (v up, as in .obj) to another.
struct UvMove {
  glm::vec2 from_low{0.0f};
  glm::vec2 from_high{1.0f};
  glm::vec2 to_low{0.0f};
  glm::vec2 to_high{1.0f};

  [[nodiscard]] glm::vec2 Apply(glm::vec2 uv) const;
};

// The input of BuildMesh(). All pointers and spans must stay valid during the call. Each span has
// one entry per position of `obj`.
struct MeshSource {
  const ObjMesh* obj = nullptr;
  std::span<const glm::vec3> positions;  // metres, model space
  std::span<const glm::vec3> normals;    // unit; see SmoothNormals()
  std::span<const Influences> influences;
  std::vector<std::uint32_t> faces;  // faces to draw, indices into obj->faces
  std::vector<int> uv_move;  // per UV of `obj`: index into uv_moves, or -1; empty: none move
  std::vector<UvMove> uv_moves;
};

// Returns one smooth unit normal per position, weighted by the corners' angles. `faces`: indices in
// `obj.faces` of the faces to use. Call it before BuildMesh() splits vertices, so that UV seams are
// invisible, and include hidden faces, so that normals at borders do not bend.
[[nodiscard]] std::vector<glm::vec3> SmoothNormals(const ObjMesh& obj,
                                                   std::span<const glm::vec3> positions,
                                                   std::span<const std::uint32_t> faces);

// Builds a mesh of triangles with one vertex per (position, UV) in use. v is flipped to point down.
// Tangents follow from the UVs; as in glTF, the bitangent points up the picture.
[[nodiscard]] character::Mesh BuildMesh(const std::string& name, int material,
                                        const MeshSource& source);

// Finds the UV islands (connected pieces of UV space) of `faces`. Returns for each UV of `obj` the
// index of its island, or -1 if no face uses it. `num_islands` receives their number.
[[nodiscard]] std::vector<int> UvIslands(const ObjMesh& obj, std::span<const std::uint32_t> faces,
                                         int* num_islands);

}  // namespace furrow::authoring
