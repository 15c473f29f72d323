// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/joint_bounds.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kBoundsPixels = 200;

glm::mat4 LookFrom(const glm::vec3& position) {
  return glm::perspective(0.5f, 1.0f, 0.01f, 10.0f) *
         glm::lookAt(position, glm::vec3(0.0f, 1.6f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f));
}

bool Everything(const character::Material&) { return true; }

// The boxes contain every vertex, skinned here, and the rectangle is not much larger than
// necessary.
TEST(JointBounds, ContainEverySkinnedVertex) {
  const character::Character head = test::MakeHead();
  test::Subject subject(head);
  subject.pose.joints[1].rotation = glm::angleAxis(0.5f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  subject.pose.joints[2].rotation = glm::angleAxis(-0.8f, glm::vec3(1, 0, 0));
  subject.Solve();
  const glm::mat4 camera = LookFrom({0.3f, 1.7f, 1.0f});
  const ScreenRect rect = JointBounds(head, Everything)
                              .Project({subject.model, {}}, camera, kBoundsPixels, kBoundsPixels);
  glm::vec2 low(kBoundsPixels);
  glm::vec2 high(0.0f);
  for (const character::Vertex& vertex : head.meshes[0].vertices) {
    glm::vec4 place(0.0f);
    for (int i = 0; i < 4; ++i) {
      const std::uint16_t joint = vertex.joints[i];
      place += vertex.skin_weights[i] * (subject.model[joint] * head.inverse_bind_matrices[joint] *
                                         glm::vec4(vertex.position, 1.0f));
    }
    const glm::vec4 clip = camera * place;
    const glm::vec2 pixel =
        (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * static_cast<float>(kBoundsPixels);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  EXPECT_LE(rect.x0, low.x);
  EXPECT_LE(rect.y0, low.y);
  EXPECT_GE(rect.x1, high.x);
  EXPECT_GE(rect.y1, high.y);
  EXPECT_LT(rect.x1 - rect.x0, 2.0f * (high.x - low.x));
}

// The boxes follow the targets of the shapes that are on, in either direction, and no others.
TEST(JointBounds, ContainMorphedVertices) {
  character::Character head = test::MakeHead();
  character::Mesh& mesh = head.meshes[0];
  head.shapes = {"left", "up", "off"};
  mesh.morph_targets.resize(3);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const float high = std::max(0.0f, mesh.vertices[i].position.y - 1.6f);
    mesh.morph_targets[0].deltas.push_back({i, {0.5f * high, 0.0f, 0.0f}});
    mesh.morph_targets[1].deltas.push_back({i, {0.0f, 0.05f, 0.0f}});
    mesh.morph_targets[2].deltas.push_back({i, {5.0f, 5.0f, 5.0f}});
  }
  for (int shape = 0; shape < 3; ++shape) mesh.morph_targets[shape].shape = shape;
  test::Subject subject(head);
  subject.pose.joints[1].rotation = glm::angleAxis(0.5f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  subject.Solve();
  const glm::mat4 camera = LookFrom({0.3f, 1.7f, 1.0f});
  const JointBounds bounds(head, Everything);
  for (const auto& [left, up] : {std::pair(1.0f, 0.5f), {-1.5f, 1.0f}, {0.5f, -2.0f}}) {
    const std::vector<float> shapes = {left, up, 0.0f};
    character::Character moved = head;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      moved.meshes[0].vertices[i].position += left * mesh.morph_targets[0].deltas[i].position +
                                              up * mesh.morph_targets[1].deltas[i].position;
    }
    moved.meshes[0].morph_targets.clear();
    const auto rect = bounds.Look({subject.model, shapes}, camera);
    const auto want = JointBounds(moved, Everything).Look({subject.model, {}}, camera);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_LE(rect.low[axis], want.low[axis] + 1e-5f);
      EXPECT_GE(rect.high[axis], want.high[axis] - 1e-5f);
      EXPECT_LT(rect.high[axis] - rect.low[axis], 2.0f * (want.high[axis] - want.low[axis]));
    }
    EXPECT_LE(rect.nearest, want.nearest + 1e-5f);
  }
}

TEST(JointBounds, NoBoxesAreEmptyAndBoxesBehindTheCameraCoverThePicture) {
  const character::Character head = test::MakeHead();
  const test::Subject subject(head);
  const JointBounds none(head, [](const character::Material&) { return false; });
  EXPECT_TRUE(
      none.Project({subject.model, {}}, LookFrom({0, 1.6f, 1}), kBoundsPixels, kBoundsPixels)
          .empty());
  const ScreenRect inside =
      JointBounds(head, Everything)
          .Project({subject.model, {}}, LookFrom({0, 1.6f, 0.01f}), kBoundsPixels, kBoundsPixels);
  EXPECT_EQ(inside.x1 - inside.x0, kBoundsPixels);
  EXPECT_EQ(inside.y1 - inside.y0, kBoundsPixels);
}

}  // namespace
}  // namespace furrow::render
