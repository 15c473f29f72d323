// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/posed_surface.h"

#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// A strip that joint 0 moves at its left end, joint 1 at its right end, and both between.
character::Mesh Strip() {
  return toys::Grid(8, 1, [](float u, float v) {
    toys::Point point;
    point.position = {0.2f * u, 0.02f * v, 0.0f};
    point.uv = {u, v};
    point.weight_of_second = u;
    return point;
  });
}

TEST(PoseSurface, MovesRigidlyWithOneMotion) {
  const character::Mesh mesh = Strip();
  const character::Mesh* const meshes[] = {&mesh};
  const Surface surface(meshes);
  const glm::mat4 motion =
      glm::translate(glm::rotate(glm::mat4(1.0f), 2.5f, vec3(0.6f, 0.8f, 0.0f)), vec3(1, 2, 3));
  const std::vector<glm::mat4> matrices(2, motion);
  const auto posed = PoseSurface(surface, matrices, surface.positions());
  for (std::size_t v = 0; v < posed.size(); ++v) {
    const vec3 expected = motion * glm::vec4(surface.positions()[v], 1.0f);
    EXPECT_LT(glm::distance(posed[v].position, expected), 1e-5f);
    EXPECT_LT(glm::distance(posed[v].turn * vec3(0, 0, 1), glm::mat3(motion) * vec3(0, 0, 1)),
              1e-5f);
  }
}

// Halfway between two rotations about one axis lies half of the angle, which blended matrices miss.
TEST(PoseSurface, TurnsHalfwayByHalfOfTheAngle) {
  const character::Mesh mesh = Strip();
  const character::Mesh* const meshes[] = {&mesh};
  const Surface surface(meshes);
  const std::vector<glm::mat4> matrices = {glm::mat4(1.0f),
                                           glm::rotate(glm::mat4(1.0f), 1.6f, vec3(1, 0, 0))};
  const auto posed = PoseSurface(surface, matrices, surface.positions());
  int checked = 0;
  for (std::size_t v = 0; v < posed.size(); ++v) {
    if (std::abs(surface.positions()[v].x - 0.1f) > 1e-5f) continue;
    const vec3 up = posed[v].turn * vec3(0, 1, 0);
    EXPECT_NEAR(up.y, std::cos(0.8f), 1e-4f);
    EXPECT_NEAR(up.z, std::sin(0.8f), 1e-4f);
    ++checked;
  }
  EXPECT_EQ(checked, 2);
}

TEST(PoseSurface, BlendsScalesLinearly) {
  const character::Mesh mesh = Strip();
  const character::Mesh* const meshes[] = {&mesh};
  const Surface surface(meshes);
  const std::vector<glm::mat4> matrices = {glm::mat4(1.0f),
                                           glm::scale(glm::mat4(1.0f), vec3(3.0f))};
  const auto posed = PoseSurface(surface, matrices, surface.positions());
  for (std::size_t v = 0; v < posed.size(); ++v) {
    const vec3& rest = surface.positions()[v];
    const float share = rest.x / 0.2f;
    EXPECT_LT(glm::distance(posed[v].position, (1.0f + 2.0f * share) * rest), 1e-5f);
  }
}

}  // namespace
}  // namespace furrow::authoring
