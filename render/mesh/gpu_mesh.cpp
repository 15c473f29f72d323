// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/gpu_mesh.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>

#include "render/mesh/displacement_patches.h"
#include "render/mesh/uv_density.h"
#include "render/mesh/weight_gradients.h"

namespace furrow::render {
namespace {

using character::Vertex;

// Attribute locations are those of shaders/scene/pose.vert.glsl. All attributes come from one
// interleaved buffer.
void DescribeVertices(GLuint array, const gl::Buffer& vertices) {
  glVertexArrayVertexBuffer(array, 0, vertices.name(), 0, sizeof(Vertex));
  const auto attribute = [&](GLuint location, GLint size, std::size_t offset) {
    glEnableVertexArrayAttrib(array, location);
    glVertexArrayAttribFormat(array, location, size, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, location, 0);
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 4, offsetof(Vertex, tangent));
  attribute(3, 2, offsetof(Vertex, uv));
  attribute(5, 4, offsetof(Vertex, skin_weights));
  // Joint numbers are integers and must not be converted to floats.
  glEnableVertexArrayAttrib(array, 4);
  glVertexArrayAttribIFormat(array, 4, 4, GL_UNSIGNED_SHORT, offsetof(Vertex, joints));
  glVertexArrayAttribBinding(array, 4, 0);
}

// The share is in a separate buffer at binding 1, because only patches need it.
void DescribeShares(GLuint array, const gl::Buffer& shares) {
  constexpr GLuint kShare = 6;  // a_share of shaders/scene/pose.vert.glsl
  glVertexArrayVertexBuffer(array, 1, shares.name(), 0, sizeof(float));
  glEnableVertexArrayAttrib(array, kShare);
  glVertexArrayAttribFormat(array, kShare, 1, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kShare, 1);
}

// The rows are in a separate buffer at binding 3, because few meshes have any.
void DescribeMorphRows(GLuint array, const gl::Buffer& rows) {
  constexpr GLuint kMorphRow = 8;  // a_morph_row of shaders/scene/pose.vert.glsl
  if (!rows) return;
  glVertexArrayVertexBuffer(array, 3, rows.name(), 0, sizeof(std::uint32_t));
  glEnableVertexArrayAttrib(array, kMorphRow);
  glVertexArrayAttribIFormat(array, kMorphRow, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array, kMorphRow, 3);
}

// The gradients are in a separate buffer at binding 4, because only skin has any.
void DescribeGradients(GLuint array, const gl::Buffer& gradients) {
  constexpr GLuint kGradient = 9;  // a_weights_along and a_weights_across of pose.vert.glsl
  if (!gradients) return;
  glVertexArrayVertexBuffer(array, 4, gradients.name(), 0, sizeof(WeightGradient));
  for (GLuint axis = 0; axis < 2; ++axis) {
    glEnableVertexArrayAttrib(array, kGradient + axis);
    glVertexArrayAttribFormat(
        array, kGradient + axis, 4, GL_FLOAT, GL_FALSE,
        axis == 0 ? offsetof(WeightGradient, along) : offsetof(WeightGradient, across));
    glVertexArrayAttribBinding(array, kGradient + axis, 4);
  }
}

// Counts inner edges twice, which does not change the mean much.
float MeanEdge(const character::Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < mesh.indices.size(); ++i) {
    sum += glm::distance(mesh.vertices[mesh.indices[i]].position,
                         mesh.vertices[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]].position);
  }
  return mesh.indices.empty() ? 0.0f
                              : static_cast<float>(sum / static_cast<double>(mesh.indices.size()));
}

// Square metres at rest.
float Surface(const character::Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& corner = mesh.vertices[mesh.indices[i]].position;
    const glm::vec3 a = mesh.vertices[mesh.indices[i + 1]].position - corner;
    const glm::vec3 b = mesh.vertices[mesh.indices[i + 2]].position - corner;
    sum += 0.5 * glm::length(glm::cross(a, b));
  }
  return static_cast<float>(sum);
}

// A copy of `gradients` with those of one vertex after another.
gl::Buffer Expanded(const gl::Buffer& gradients, std::span<const std::uint32_t> vertices) {
  GLint bytes = 0;
  glGetNamedBufferParameteriv(gradients.name(), GL_BUFFER_SIZE, &bytes);
  std::vector<WeightGradient> source(static_cast<std::size_t>(bytes) / sizeof(WeightGradient));
  glGetNamedBufferSubData(gradients.name(), 0, bytes, source.data());
  std::vector<WeightGradient> expanded;
  expanded.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) expanded.push_back(source[vertex]);
  return gl::MakeStaticBuffer(expanded.data(), expanded.size() * sizeof(WeightGradient));
}

// Moves the vertices of coarse levels to the front. Each level uses vertices of the finer ones.
void SortByLevel(character::Mesh* source, std::vector<MeshLevel>* levels, GpuMesh* mesh) {
  std::vector<std::size_t> coarsest(source->vertices.size());
  for (std::size_t level = 0; level < levels->size(); ++level) {
    for (const std::uint32_t vertex : (*levels)[level].indices) coarsest[vertex] = level;
  }
  std::vector<std::uint32_t> order(coarsest.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::greater(),
                           [&](std::uint32_t vertex) { return coarsest[vertex]; });
  std::vector<Vertex> sorted;
  std::vector<std::uint32_t> number(order.size());
  for (const std::uint32_t vertex : order) {
    number[vertex] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(source->vertices[vertex]);
  }
  for (MeshLevel& level : *levels) {
    for (std::uint32_t& vertex : level.indices) vertex = number[vertex];
  }
  for (MeshCluster& cluster : mesh->clusters) {
    const auto indices = std::span<const std::uint32_t>((*levels)[0].indices)
                             .subspan(cluster.indices.first, cluster.indices.count);
    cluster.vertices = VertexBlocks(indices, sorted.size());
  }
  ++mesh->order;
  mesh->vertices = gl::MakeStaticBuffer(sorted.data(), sorted.size() * sizeof(Vertex));
  DescribeVertices(mesh->vertex_array.name(), mesh->vertices);
}

}  // namespace

// The mesh is uploaded once and not kept in memory. Variants, which few pictures need, read it
// back.
character::Mesh ReadMesh(const GpuMesh& mesh) {
  character::Mesh read;
  read.indices.resize(static_cast<std::size_t>(mesh.num_indices));
  glGetNamedBufferSubData(mesh.indices.name(), 0, static_cast<GLsizeiptr>(read.indices.size() * 4),
                          read.indices.data());
  GLint bytes = 0;
  glGetNamedBufferParameteriv(mesh.vertices.name(), GL_BUFFER_SIZE, &bytes);
  read.vertices.resize(static_cast<std::size_t>(bytes) / sizeof(Vertex));
  glGetNamedBufferSubData(mesh.vertices.name(), 0,
                          static_cast<GLsizeiptr>(read.vertices.size() * sizeof(Vertex)),
                          read.vertices.data());
  return read;
}

GpuMesh MakeGpuMesh(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices) {
  GpuMesh gpu;
  gpu.vertices = gl::MakeStaticBuffer(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vertex));
  gpu.indices = gl::MakeStaticBuffer(mesh.indices.data(), mesh.indices.size() * 4);
  gpu.vertex_array = gl::MakeVertexArray();
  gpu.num_vertices = static_cast<GLsizei>(mesh.vertices.size());
  gpu.num_indices = static_cast<GLsizei>(mesh.indices.size());
  gpu.material = mesh.material;
  gpu.mean_edge = MeanEdge(mesh);
  gpu.surface = Surface(mesh);
  gpu.uv_per_metre = MinUvPerMetre(mesh);
  gpu.bounds = JointBounds(mesh, inverse_bind_matrices);
  gpu.morphs = MeshMorphs(mesh);
  if (!gpu.morphs.empty()) {
    const auto rows = gpu.morphs.rows();
    gpu.morph_rows = gl::MakeStaticBuffer(rows.data(), rows.size_bytes());
  }
  DescribeVertices(gpu.vertex_array.name(), gpu.vertices);
  DescribeMorphRows(gpu.vertex_array.name(), gpu.morph_rows);
  glVertexArrayElementBuffer(gpu.vertex_array.name(), gpu.indices.name());
  return gpu;
}

void AddGradients(const character::Mesh& source, GpuMesh* mesh) {
  const std::vector<WeightGradient> gradients = WeightGradients(source);
  if (gradients.empty()) return;
  mesh->gradients =
      gl::MakeStaticBuffer(gradients.data(), gradients.size() * sizeof(WeightGradient));
  DescribeGradients(mesh->vertex_array.name(), mesh->gradients);
}

void AddLevels(GpuMesh* mesh, Borders borders) {
  character::Mesh source = ReadMesh(*mesh);
  source.morph_targets = mesh->morphs.Positions();
  std::vector<MeshLevel> levels = MakeMeshLevels(source, borders);
  if (mesh->morphs.empty() && !mesh->gradients) SortByLevel(&source, &levels, mesh);
  std::vector<std::uint32_t> indices;
  for (const MeshLevel& level : levels) {
    const std::uint32_t last = level.indices.empty() ? 0 : std::ranges::max(level.indices);
    mesh->levels.push_back({static_cast<GLsizei>(indices.size()),
                            static_cast<GLsizei>(level.indices.size()), level.error, last + 1});
    indices.insert(indices.end(), level.indices.begin(), level.indices.end());
  }
  mesh->indices = gl::MakeStaticBuffer(indices.data(), indices.size() * 4);
  glVertexArrayElementBuffer(mesh->vertex_array.name(), mesh->indices.name());
}

GpuMesh MakeUnindexed(const GpuMesh& mesh) {
  const character::Mesh source = ReadMesh(mesh);
  std::vector<Vertex> expanded;
  expanded.reserve(source.indices.size());
  for (const std::uint32_t vertex : source.indices) expanded.push_back(source.vertices[vertex]);
  GpuMesh gpu;
  gpu.vertices = gl::MakeStaticBuffer(expanded.data(), expanded.size() * sizeof(Vertex));
  gpu.vertex_array = gl::MakeVertexArray();
  gpu.num_vertices = gpu.num_indices = mesh.num_indices;
  gpu.material = mesh.material;
  DescribeVertices(gpu.vertex_array.name(), gpu.vertices);
  if (mesh.gradients) {
    gpu.gradients = Expanded(mesh.gradients, source.indices);
    DescribeGradients(gpu.vertex_array.name(), gpu.gradients);
  }
  if (mesh.morphs.empty()) return gpu;
  std::vector<std::uint32_t> rows;
  rows.reserve(source.indices.size());
  for (const std::uint32_t vertex : source.indices) rows.push_back(mesh.morphs.rows()[vertex]);
  gpu.morph_rows = gl::MakeStaticBuffer(rows.data(), rows.size() * sizeof(std::uint32_t));
  DescribeMorphRows(gpu.vertex_array.name(), gpu.morph_rows);
  return gpu;
}

GpuPatches MakePatches(const GpuMesh& mesh) {
  const DisplacementPatches patches = MakeDisplacementPatches(ReadMesh(mesh));
  GpuPatches gpu;
  gpu.indices = gl::MakeStaticBuffer(patches.indices.data(), patches.indices.size() * 4);
  gpu.shares = gl::MakeStaticBuffer(patches.shares.data(), patches.shares.size() * sizeof(float));
  gpu.vertex_array = gl::MakeVertexArray();
  gpu.num_indices = static_cast<GLsizei>(patches.indices.size());
  gpu.metres_per_uv = patches.metres_per_uv;
  DescribeVertices(gpu.vertex_array.name(), mesh.vertices);
  DescribeShares(gpu.vertex_array.name(), gpu.shares);
  DescribeMorphRows(gpu.vertex_array.name(), mesh.morph_rows);
  DescribeGradients(gpu.vertex_array.name(), mesh.gradients);
  glVertexArrayElementBuffer(gpu.vertex_array.name(), gpu.indices.name());
  return gpu;
}

}  // namespace furrow::render
