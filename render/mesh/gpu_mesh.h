// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/character.h"
#include "render/gl/gl_objects.h"
#include "render/mesh/joint_bounds.h"
#include "render/mesh/mesh_levels.h"

namespace furrow::render {

// A mesh on the GPU in its rest pose, as shaders/scene/pose.vert.glsl reads it.
struct GpuMesh {
  gl::VertexArray vertex_array;
  gl::Buffer vertices;
  gl::Buffer indices;
  JointBounds bounds;  // of the posed mesh
  GLsizei num_vertices = 0;
  GLsizei num_indices = 0;
  int material = 0;
  float mean_edge = 0.0f;     // metres, of the rest pose
  float surface = 0.0f;       // square metres
  float uv_per_metre = 0.0f;  // ... of where the texture is stretched most, outliers left out

  // A range of `indices`: the whole mesh, then with ever fewer triangles
  // (render/mesh/mesh_levels.h).
  struct Level {
    GLsizei first = 0;
    GLsizei count = 0;
    float error = 0.0f;  // metres
  };
  std::vector<Level> levels;  // empty: not made yet, there is the whole mesh alone
};

// The same surface as patches of DisplacementPatches::kCorners vertices, for tessellation.
struct GpuPatches {
  gl::VertexArray vertex_array;
  gl::Buffer indices;
  gl::Buffer shares;
  GLsizei num_indices = 0;
  float metres_per_uv = 1.0f;  // of the rest pose: root of surface over surface in the atlas
};

// Needs a current context, as all of these. `mesh` is checked.
[[nodiscard]] GpuMesh MakeGpuMesh(const character::Mesh& mesh,
                                  std::span<const glm::mat4> inverse_bind_matrices);
// Gives a mesh its levels.
void AddLevels(GpuMesh* mesh, Borders borders);
// The whole mesh as it was uploaded: nobody keeps it.
[[nodiscard]] character::Mesh ReadMesh(const GpuMesh& mesh);
// With three vertices of its own to every triangle, for the view wireframe.
[[nodiscard]] GpuMesh MakeUnindexed(const GpuMesh& mesh);
// Shares the vertices of `mesh`, which outlives it.
[[nodiscard]] GpuPatches MakePatches(const GpuMesh& mesh);

}  // namespace furrow::render
