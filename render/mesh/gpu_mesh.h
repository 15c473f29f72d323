// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/character.h"
#include "render/gl/gl_objects.h"
#include "render/mesh/joint_bounds.h"
#include "render/mesh/mesh_clusters.h"
#include "render/mesh/mesh_levels.h"
#include "render/mesh/mesh_morphs.h"

namespace furrow::render {

// A mesh on the GPU in its rest pose, in the vertex format of shaders/scene/pose.vert.glsl.
struct GpuMesh {
  gl::VertexArray vertex_array;
  gl::Buffer vertices;
  gl::Buffer indices;
  MeshMorphs morphs;
  gl::Buffer morph_rows;  // MeshMorphs::rows(), per vertex of this object; none without morphs
  gl::Buffer gradients;   // WeightGradients(), per vertex; none unless AddGradients() found any
  JointBounds bounds;     // bounds of the posed mesh
  std::vector<MeshCluster> clusters;  // of level 0
  GLsizei num_vertices = 0;
  GLsizei num_indices = 0;
  int material = 0;           // index into Character::materials
  float mean_edge = 0.0f;     // mean edge length in metres, rest pose
  float surface = 0.0f;       // area in square metres, rest pose
  float uv_per_metre = 0.0f;  // MinUvPerMetre(): UV distance per metre where stretched most

  // One level of detail: a range of `indices`. Level 0 is the whole mesh; each further level has
  // fewer triangles (render/mesh/mesh_levels.h).
  struct Level {
    GLsizei first = 0;
    GLsizei count = 0;
    float error = 0.0f;  // RMS distance from the surface of level 0 in the rest pose, metres
    std::uint32_t num_vertices = 0;  // the level uses none but the first of the mesh
  };
  int order = 0;              // another one: AddLevels() has sorted the vertices
  std::vector<Level> levels;  // empty until AddLevels(): use the whole mesh
};

// The triangles of a GpuMesh as tessellation patches (DisplacementPatches) on the GPU.
struct GpuPatches {
  gl::VertexArray vertex_array;
  gl::Buffer indices;
  gl::Buffer shares;
  GLsizei num_indices = 0;
  float metres_per_uv = 1.0f;  // DisplacementPatches::metres_per_uv
};

// Uploads a mesh whose indices are in range. This and the functions below need a current context.
[[nodiscard]] GpuMesh MakeGpuMesh(const character::Mesh& mesh,
                                  std::span<const glm::mat4> inverse_bind_matrices);
// Computes and uploads the gradients of the skin weights (WeightGradients()), so that the normals
// of the posed mesh follow its surface. `source`: the mesh that `mesh` was made from.
void AddGradients(const character::Mesh& source, GpuMesh* mesh);
// Computes the levels of detail (MakeMeshLevels()), uploads them and fills mesh->levels. Sorts the
// vertices of a mesh without morph targets and gradients, so that coarse levels use few of them.
void AddLevels(GpuMesh* mesh, Borders borders);
// Reads the whole mesh, without morph targets, back from the GPU, where its only copy is.
[[nodiscard]] character::Mesh ReadMesh(const GpuMesh& mesh);
// A copy of `mesh` without an index buffer, for the view wireframe: each triangle has three
// vertices of its own. Its `morphs` are empty; its rows refer to those of `mesh`.
[[nodiscard]] GpuMesh MakeUnindexed(const GpuMesh& mesh);
// Makes the patches of a mesh. They use the vertices of `mesh`, which must outlive them.
[[nodiscard]] GpuPatches MakePatches(const GpuMesh& mesh);

}  // namespace furrow::render
