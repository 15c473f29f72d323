// SPDX-License-Identifier: Apache-2.0
// Normals of skin that joints bend without turning, compared with a surface that has them at rest.
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using character::Character;
using character::Vertex;

constexpr float kRise = 0.5f;  // metres
constexpr float kRidgeWidth = 0.4f;

// The share of joint 1: a smooth ridge along y.
float Share(float x) { return std::exp(-x * x / (kRidgeWidth * kRidgeWidth)); }

// A sheet of 2 m with one joint for its sides and one for its middle.
Character Sheet(character::Material::Kind kind) {
  Character sheet = test::MakeSheet(64, 4, [](Vertex* vertex) {
    vertex->joints[1] = 1;
    vertex->skin_weights[1] = Share(vertex->position.x);
    vertex->skin_weights[0] = 1.0f - vertex->skin_weights[1];
  });
  test::SetSkeleton(
      {test::Joint("sides", -1, glm::vec3(0.0f)), test::Joint("middle", 0, glm::vec3(0.0f))},
      &sheet);
  sheet.materials[0].kind = kind;
  return sheet;
}

// The same ridge at rest, with the normals of z = kRise * Share(x).
Character Ridge() {
  Character ridge = Sheet(character::Material::Kind::kSkin);
  for (Vertex& vertex : ridge.meshes[0].vertices) {
    const float x = vertex.position.x;
    const float slope = -2.0f * x / (kRidgeWidth * kRidgeWidth) * kRise * Share(x);
    vertex.position.z = kRise * Share(x);
    vertex.normal = glm::normalize(glm::vec3(-slope, 0.0f, 1.0f));
    vertex.tangent = glm::vec4(glm::normalize(glm::vec3(1.0f, 0.0f, slope)), 1.0f);
    vertex.joints[1] = 0;
    vertex.skin_weights[0] = 1.0f;
    vertex.skin_weights[1] = 0.0f;
  }
  return ridge;
}

Image Normals(const Character& character, float rise, Shading shading = Shading::kDiffuse) {
  Camera camera;
  camera.position = {0.0f, 0.0f, 4.0f};
  camera.target = {0.0f, 0.0f, 0.0f};
  test::Subject subject(character);
  subject.pose.joints[1].translation.z += rise;
  subject.Solve();
  FrameRequest request = test::SceneRequest(character, camera, 96, 96);
  request.model = subject.model;
  request.settings.view = View::kNormal;
  request.settings.shading = shading;
  request.settings.anti_aliasing.samples = 1;
  const auto renderer = test::Expect(Renderer::Create(character));
  return test::Expect(renderer->Render(request));
}

// The mean difference of the channels.
double MeanDifference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(int{a.rgb[i]} - int{b.rgb[i]});
  return sum / static_cast<double>(a.rgb.size());
}

TEST(SurfaceNormals, FollowSkinThatBendsWithoutTurning) {
  const Image want = Normals(Ridge(), 0.0f);
  EXPECT_LT(MeanDifference(Normals(Sheet(character::Material::Kind::kSkin), kRise), want), 0.6);
  // Cloth turns with its joints only, and these do not turn.
  EXPECT_GT(MeanDifference(Normals(Sheet(character::Material::Kind::kCloth), kRise), want), 5.0);
}

TEST(SurfaceNormals, AtRestAreThoseOfTheFile) {
  const Image skin = Normals(Sheet(character::Material::Kind::kSkin), 0.0f);
  EXPECT_EQ(skin.rgb, Normals(Sheet(character::Material::Kind::kCloth), 0.0f).rgb);
}

// A motion that all joints share does not bend the surface.
TEST(SurfaceNormals, IgnoreRigidMotion) {
  const Character sheet = Sheet(character::Material::Kind::kSkin);
  test::Subject subject(sheet);
  subject.pose.joints[0].translation.x += 0.2f;
  subject.pose.joints[0].rotation = glm::angleAxis(0.5f, glm::vec3(0.0f, 1.0f, 0.0f));
  subject.Solve();
  Camera camera;
  camera.position = {0.0f, 0.0f, 4.0f};
  FrameRequest request = test::SceneRequest(sheet, camera, 96, 96);
  request.model = subject.model;
  request.settings.view = View::kNormal;
  const auto skin = test::Expect(Renderer::Create(sheet));
  const Character as_cloth = Sheet(character::Material::Kind::kCloth);
  const auto cloth = test::Expect(Renderer::Create(as_cloth));
  EXPECT_LT(
      MeanDifference(test::Expect(skin->Render(request)), test::Expect(cloth->Render(request))),
      0.05);
}

}  // namespace
}  // namespace furrow::render
