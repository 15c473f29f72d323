// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/move_mesh.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace furrow::character {
namespace {

// One vertex of which a target moves everything, in a triangle.
Mesh OneMovedVertex() {
  Mesh mesh;
  mesh.vertices.resize(3);
  mesh.vertices[0].position = {1, 2, 3};
  mesh.vertices[0].normal = glm::normalize(glm::vec3(1, 2, 2));
  mesh.vertices[0].tangent = glm::vec4(glm::normalize(glm::vec3(2, -1, 0)), -1.0f);
  mesh.vertices[1].position = {1, 0, 0};
  mesh.vertices[2].position = {0, 1, 0};
  mesh.indices = {0, 1, 2};
  mesh.morph_targets = {
      {0, {{0, glm::vec3(0.1f, -0.2f, 0.3f), glm::vec3(0.2f, 0, -0.1f), glm::vec3(0, 0.3f, 0)}}}};
  return mesh;
}

struct Morphed {
  glm::vec3 position, normal, tangent;
};

Morphed Morph(const Mesh& mesh, float weight) {
  const MorphDelta& delta = mesh.morph_targets[0].deltas[0];
  const Vertex& vertex = mesh.vertices[0];
  return {vertex.position + weight * delta.position,
          glm::normalize(vertex.normal + weight * delta.normal),
          glm::normalize(glm::vec3(vertex.tangent) + weight * delta.tangent)};
}

void ExpectNear(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-5f)
      << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

class MovedMesh : public ::testing::TestWithParam<glm::mat4> {};

// To move and then to morph gives what to morph and then to move gives.
TEST_P(MovedMesh, MorphsAsBefore) {
  const glm::mat4 m = GetParam();
  const glm::mat3 axes(m);
  const Mesh before = OneMovedVertex();
  Mesh after = before;
  MoveMesh([&](const Vertex&) { return m; }, &after);
  for (const float weight : {0.0f, 0.5f, 1.0f, -0.7f}) {
    const Morphed from = Morph(before, weight);
    const Morphed to = Morph(after, weight);
    ExpectNear(to.position, glm::vec3(m * glm::vec4(from.position, 1.0f)));
    ExpectNear(to.normal, glm::normalize(glm::transpose(glm::inverse(axes)) * from.normal));
    ExpectNear(to.tangent, glm::normalize(axes * from.tangent));
  }
  EXPECT_EQ(after.vertices[0].tangent.w, -1.0f);
  const bool mirrors = glm::determinant(axes) < 0.0f;
  EXPECT_EQ(after.indices[1], mirrors ? 2u : 1u);
}

INSTANTIATE_TEST_SUITE_P(
    All, MovedMesh,
    ::testing::Values(glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(4, 5, 6)),
                      glm::rotate(glm::mat4(1.0f), 1.0f, glm::normalize(glm::vec3(1, 1, 2))),
                      glm::scale(glm::mat4(1.0f), glm::vec3(1e-3f)),
                      glm::rotate(glm::scale(glm::mat4(1.0f), glm::vec3(2, 0.5f, 3)), 0.5f,
                                  glm::vec3(0, 1, 0)),
                      glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1))));

TEST(MoveMesh, KeepsDirectionsThatBecomeZero) {
  Mesh mesh = OneMovedVertex();
  MoveMesh([](const Vertex&) { return glm::scale(glm::mat4(1.0f), glm::vec3(0.0f)); }, &mesh);
  EXPECT_EQ(mesh.vertices[0].normal, OneMovedVertex().vertices[0].normal);
  EXPECT_EQ(mesh.morph_targets[0].deltas[0].position, glm::vec3(0.0f));
}

}  // namespace
}  // namespace furrow::character
