// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_pass.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/request/camera_preset.h"
#include "tests/unit/render/scene_probe.h"
#include "tests/unit/render/test_character.h"
#include "wrinkle/weights/vertex_influence.h"

namespace furrow::render {
namespace {

constexpr int kSceneSize = 128;
constexpr float kTwoPi = 6.2831853f;

FrameRequest RequestOf(const test::Subject& subject, View view) {
  FrameRequest request;
  request.model = subject.model;
  request.binding = &subject.binding;
  request.wrinkle_weights = subject.weights;
  request.filtered_values = subject.driver_values;
  request.settings.view = view;
  request.width = request.height = kSceneSize;
  return request;
}

Camera FaceOf(const character::Character& character) { return CameraPresets(character)[0].second; }

// A camera that maps texel (x, y) of a plane's kSceneSize maps to pixel (x, kSceneSize - 1 - y).
Camera OverPlane() {
  Camera camera;
  camera.fov_y_degrees = 30.0f;
  camera.target = {0.0f, 0.0f, 0.0f};
  camera.position = {0.0f, 0.0f, 1.0f / std::tan(glm::radians(15.0f))};
  return camera;
}

// Heights with slopes of up to about 0.5, and their gradient by u and v.
struct Wave {
  float cycles_u;
  float cycles_v;
  float height;
  float operator()(float u, float v) const {
    return height * std::sin(kTwoPi * (cycles_u * u + cycles_v * v));
  }
  glm::dvec2 Gradient(double u, double v) const {
    const double slope = height * kTwoPi * std::cos(kTwoPi * (cycles_u * u + cycles_v * v));
    return {cycles_u * slope, cycles_v * slope};
  }
};

constexpr Wave kBase{1, 2, 0.02f};
constexpr Wave kFirst{2, -1, 0.015f};
constexpr Wave kSecond{0, 3, 0.01f};

character::Character WavyPlane() { return test::MakePlane(kSceneSize, kBase, {kFirst, kSecond}); }

// Unit normal of the sum of both height fields, in a tangent space with y up in the picture.
glm::dvec3 NormalOf(double u, double v, double first, double second) {
  const glm::dvec2 gradient =
      kBase.Gradient(u, v) + first * kFirst.Gradient(u, v) + second * kSecond.Gradient(u, v);
  return glm::normalize(glm::dvec3(-gradient.x, gradient.y, 1.0));
}

glm::vec3 NormalAt(const std::vector<glm::vec4>& pixels, int x, int y) {
  return glm::vec3(pixels[static_cast<std::size_t>((kSceneSize - 1 - y) * kSceneSize + x)]) * 2.0f -
         1.0f;
}

TEST(ScenePass, PartialDerivativesGiveTheNormalOfTheSummedHeights) {
  const character::Character plane = WavyPlane();
  test::SceneProbe probe(plane);
  test::Subject subject(plane);
  subject.Set("r0", 0.3f);
  subject.Set("r1", 0.8f);
  subject.Solve();
  FrameRequest request = RequestOf(subject, View::kNormal);
  request.camera = OverPlane();
  const std::vector<glm::vec4> pixels = probe.Draw(request);
  double worst = 0.0;
  for (int y = 0; y < kSceneSize; ++y) {
    for (int x = 0; x < kSceneSize; ++x) {
      const glm::dvec3 expected =
          NormalOf((x + 0.5) / kSceneSize, (y + 0.5) / kSceneSize, 0.3, 0.8);
      worst = std::max(worst, glm::length(expected - glm::dvec3(NormalAt(pixels, x, y))));
    }
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(ScenePass, TheTangentSpaceBlendMatchesTheFormula) {
  const character::Character plane = WavyPlane();
  test::SceneProbe probe(plane);
  test::Subject subject(plane);
  subject.Set("r0", 0.4f);
  subject.Set("r1", 0.7f);
  subject.Solve();
  FrameRequest request = RequestOf(subject, View::kNormal);
  request.camera = OverPlane();
  request.settings.normal_blend = NormalBlend::kTangentSpace;
  const std::vector<glm::vec4> pixels = probe.Draw(request);
  const auto normal = [](const Wave& wave, double u, double v) {
    const glm::dvec2 gradient = wave.Gradient(u, v);
    return glm::normalize(glm::dvec3(-gradient.x, gradient.y, 1.0));
  };
  double worst = 0.0;
  for (int y = 0; y < kSceneSize; ++y) {
    for (int x = 0; x < kSceneSize; ++x) {
      const double u = (x + 0.5) / kSceneSize;
      const double v = (y + 0.5) / kSceneSize;
      const glm::dvec3 b = normal(kBase, u, v);
      const glm::dvec3 n0 = normal(kFirst, u, v);
      const glm::dvec3 n1 = normal(kSecond, u, v);
      const glm::dvec3 expected =
          glm::normalize(glm::dvec3(b.x + 0.4 * n0.x + 0.7 * n1.x, b.y + 0.4 * n0.y + 0.7 * n1.y,
                                    b.z * (1.0 + 0.4 * (n0.z - 1.0)) * (1.0 + 0.7 * (n1.z - 1.0))));
      worst = std::max(worst, glm::length(expected - glm::dvec3(NormalAt(pixels, x, y))));
    }
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(ScenePass, WeightZeroGivesExactlyTheBase) {
  const character::Character plane = WavyPlane();
  test::SceneProbe probe(plane);
  const test::Subject neutral(plane);
  test::Subject wrinkled(plane);
  wrinkled.Set("r0", 1.0f);
  wrinkled.Solve();
  FrameRequest base = RequestOf(neutral, View::kFinal);
  base.camera = OverPlane();
  base.binding = nullptr;
  FrameRequest at_zero = RequestOf(neutral, View::kFinal);
  at_zero.camera = base.camera;
  FrameRequest switched_off = RequestOf(wrinkled, View::kFinal);
  switched_off.camera = base.camera;
  switched_off.settings.wrinkles = false;
  FrameRequest no_strength = RequestOf(wrinkled, View::kFinal);
  no_strength.camera = base.camera;
  no_strength.settings.wrinkle_strength = 0.0f;
  FrameRequest full = RequestOf(wrinkled, View::kFinal);
  full.camera = base.camera;
  const std::vector<glm::vec4> expected = probe.Draw(base);
  EXPECT_EQ(probe.Draw(at_zero), expected);
  EXPECT_EQ(probe.Draw(switched_off), expected);
  EXPECT_EQ(probe.Draw(no_strength), expected);
  EXPECT_NE(probe.Draw(full), expected);
}

// A character with vertices skinned here gives the same picture.
// Normals of skin follow the surface as well (surface_normals_test.cpp), so this head is not skin.
TEST(ScenePass, GpuSkinningMatchesCpuSkinning) {
  character::Character head = test::MakeHead();
  for (character::Material& material : head.materials) {
    material.kind = character::Material::Kind::kOther;
  }
  test::Subject subject(head);
  subject.pose.joints[1].rotation = glm::angleAxis(0.4f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  subject.pose.joints[2].rotation = glm::angleAxis(-0.8f, glm::vec3(1, 0, 0));
  subject.pose.joints[2].translation += glm::vec3(0.01f, 0.02f, 0.01f);
  subject.Solve();
  character::Character posed = head;
  for (character::Vertex& vertex : posed.meshes[0].vertices) {
    glm::mat4 skin(0.0f);
    for (int i = 0; i < 4; ++i) {
      const std::uint16_t joint = vertex.joints[i];
      skin += vertex.skin_weights[i] * subject.model[joint] * head.inverse_bind_matrices[joint];
    }
    vertex.position = glm::vec3(skin * glm::vec4(vertex.position, 1.0f));
    vertex.normal = glm::normalize(glm::mat3(skin) * vertex.normal);
    vertex.tangent =
        glm::vec4(glm::normalize(glm::mat3(skin) * glm::vec3(vertex.tangent)), vertex.tangent.w);
  }
  FrameRequest moving = RequestOf(subject, View::kNormal);
  moving.binding = nullptr;
  moving.camera = FaceOf(head);
  moving.camera.follow_joint = -1;
  FrameRequest still = moving;
  const std::vector<glm::mat4> rest(head.skeleton.rest_model().begin(),
                                    head.skeleton.rest_model().end());
  still.model = rest;
  const std::vector<glm::vec4> on_gpu = test::SceneProbe(head).Draw(moving);
  const std::vector<glm::vec4> on_cpu = test::SceneProbe(posed).Draw(still);
  int different = 0;
  int covered = 0;
  for (std::size_t i = 0; i < on_gpu.size(); ++i) {
    if (glm::length(on_gpu[i] - on_cpu[i]) > 2e-3f) ++different;
    if (glm::length(glm::vec3(on_cpu[i])) > 0.0f) ++covered;
  }
  EXPECT_GT(covered, kSceneSize * kSceneSize / 4);
  EXPECT_LE(different, 4);  // pixels on an edge may belong to either side
}

// An egg where the three corners of each triangle have the same skin weights, so that a triangle
// has a single mask value.
character::Character FacetedHead() {
  character::Character head = test::MakeHead();
  character::Mesh& mesh = head.meshes[0];
  std::vector<character::Vertex> corners;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    character::Vertex corner = mesh.vertices[mesh.indices[i]];
    const character::Vertex& first = mesh.vertices[mesh.indices[i - i % 3]];
    std::copy_n(first.joints, 4, corner.joints);
    std::copy_n(first.skin_weights, 4, corner.skin_weights);
    corners.push_back(corner);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    mesh.indices[i] = static_cast<std::uint32_t>(i);
  }
  mesh.vertices = std::move(corners);
  return head;
}

class DynamicMask : public testing::TestWithParam<wrinkle::LambdaMode> {};

TEST_P(DynamicMask, MatchesTheCpuReference) {
  character::Character head = FacetedHead();
  head.rig.regions[2].mask.lambda = GetParam();
  test::SceneProbe probe(head);
  test::Subject subject(head);
  const auto flexed = std::find(subject.binding.driver_value_names().begin(),
                                subject.binding.driver_value_names().end(), "brow.flexed");
  subject.driver_values[flexed - subject.binding.driver_value_names().begin()] = 0.7f;
  FrameRequest request = RequestOf(subject, View::kMaskDynamic);
  request.camera = FaceOf(head);
  const std::vector<glm::vec4> pixels = probe.Draw(request);
  const ActiveMap map = probe.tables().table(WrinkleGroup::kSkin).maps.at(0);
  const DynamicMaskBlock mask = probe.tables().table(WrinkleGroup::kSkin).dynamic_masks.at(0);
  const CameraFrame camera = ComputeCamera(request.camera, head.skeleton, subject.model, 1.0f);
  const std::vector<character::Vertex>& vertices = head.meshes[0].vertices;
  int compared = 0;
  int masked = 0;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    const glm::vec3 centre =
        (vertices[i].position + vertices[i + 1].position + vertices[i + 2].position) / 3.0f;
    if (glm::dot(vertices[i].normal, glm::normalize(camera.position - centre)) < 0.6f) continue;
    const glm::vec4 clip = camera.view_projection * glm::vec4(centre, 1.0f);
    const int x = static_cast<int>((clip.x / clip.w * 0.5f + 0.5f) * kSceneSize);
    const int y = static_cast<int>((clip.y / clip.w * 0.5f + 0.5f) * kSceneSize);
    const float expected = wrinkle::VertexInfluence(
        vertices[i].joints, vertices[i].skin_weights, probe.tables().influences(),
        probe.tables().mask_columns(), mask.column, GetParam(), 0.25f);
    const float drawn = pixels[static_cast<std::size_t>(y * kSceneSize + x)].b / map.colour.b;
    // Triangles smaller than a pixel may miss its centre; the masks of their neighbours are
    // similar.
    EXPECT_NEAR(drawn, expected, GetParam() == wrinkle::LambdaMode::kBinary ? 0.71f : 0.25f);
    if (std::abs(drawn - expected) < 1e-3f) ++compared;
    if (expected > 0.1f) ++masked;
  }
  EXPECT_GT(compared, 250);
  EXPECT_GT(masked, 20);
}

INSTANTIATE_TEST_SUITE_P(Lambda, DynamicMask,
                         testing::Values(wrinkle::LambdaMode::kSmooth, wrinkle::LambdaMode::kBinary,
                                         wrinkle::LambdaMode::kLinear));

}  // namespace
}  // namespace furrow::render
