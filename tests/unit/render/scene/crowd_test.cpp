// SPDX-License-Identifier: Apache-2.0
// Several subjects in one picture.
#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/picture_difference.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kCrowdWidth = 240;
constexpr int kCrowdHeight = 120;
constexpr int kNumPeople = 3;

PosedSubject DrawnAs(const test::Subject& subject, const glm::mat4& placement) {
  return {subject.model, {}, &subject.binding, subject.weights, subject.driver_values, placement};
}

glm::mat4 Spot(int i) {
  const float turn = 0.3f * static_cast<float>(i - 1);
  const glm::mat4 place = glm::translate(
      glm::mat4(1.0f), {0.35f * static_cast<float>(i - 1), 0.02f * static_cast<float>(i), 0.0f});
  return glm::scale(glm::rotate(place, turn, glm::vec3(0, 1, 0)),
                    glm::vec3(1.0f - 0.05f * static_cast<float>(i)));
}

// Shows all three subjects, with space between them.
Camera OverAll() {
  Camera camera;
  camera.position = {0.0f, 1.6f, 1.6f};
  camera.target = {0.0f, 1.6f, 0.0f};
  return camera;
}

// Three faces: stretched on the left; squashed on the right with a bent brow; neutral.
class Crowd : public testing::Test {
 protected:
  Crowd() : renderer_(test::Expect(Renderer::Create(head_))) {
    for (int i = 0; i < kNumPeople; ++i) people_.emplace_back(head_);
    people_[0].Set("l_stretch", 1.0f);
    people_[1].Set("r_squash", 0.8f);
    people_[1].pose.joints[2].rotation = glm::angleAxis(1.1f, glm::vec3(1, 0, 0));
    people_[2].pose.joints[1].rotation = glm::angleAxis(0.3f, glm::vec3(0, 0, 1));
    for (test::Subject& subject : people_) subject.Solve();
    for (int i = 0; i < kNumPeople; ++i) drawn_.push_back(DrawnAs(people_[i], Spot(i)));
    request_.camera = OverAll();
    request_.width = kCrowdWidth;
    request_.height = kCrowdHeight;
    request_.settings.detail.error_pixels = 0.0f;
    // Crowds evaluate their wrinkles in every fragment.
    request_.settings.wrinkle_maps.cache = false;
  }

  Image Draw(std::span<const PosedSubject> subjects) {
    static_cast<PosedSubject&>(request_) = subjects.front();
    request_.others = subjects.subspan(1);
    return test::Expect(renderer_->Render(request_));
  }

  // Number of pixels that differ between one picture of all subjects and the combined pictures of
  // each.
  int DifferentFromEachAlone() {
    const Image all = Draw(drawn_);
    PosedSubject nobody = drawn_[0];
    nobody.placement = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 50.0f, 0.0f));
    const Image empty = Draw(std::span(&nobody, 1));
    Image composed = empty;
    int most = 0;
    for (const PosedSubject& subject : drawn_) {
      const Image alone = Draw(std::span(&subject, 1));
      int covered = 0;
      for (std::size_t pixel = 0; pixel < alone.rgb.size() / 3; ++pixel) {
        if (test::DifferenceAt(alone, empty, pixel) == 0) continue;
        EXPECT_EQ(test::DifferenceAt(composed, empty, pixel), 0) << "the subjects overlap";
        std::copy_n(&alone.rgb[3 * pixel], 3, &composed.rgb[3 * pixel]);
        ++covered;
      }
      most = std::max(most, covered);
    }
    EXPECT_GT(most, 100)
        << "nothing is visible";  // the masks of a neutral subject are black on black
    return test::NumDifferent(all, composed, 1);
  }

  character::Character head_ = test::MakeHead();
  std::unique_ptr<Renderer> renderer_;
  std::vector<test::Subject> people_;
  std::vector<PosedSubject> drawn_;
  FrameRequest request_;
};

TEST_F(Crowd, EqualsThePicturesOfEachCombined) {
  for (const View view : {View::kFinal, View::kNormal, View::kWeights, View::kMaskDynamic,
                          View::kMaskTexture, View::kWireframe}) {
    request_.settings.view = view;
    EXPECT_EQ(DifferentFromEachAlone(), 0) << ViewName(view);
  }
}

TEST_F(Crowd, WithSkinShadingEqualsThePicturesOfEachCombined) {
  request_.settings.shading = Shading::kSkin;
  request_.settings.shadow.filter = ShadowFilter::kOff;  // they would cast shadows on each other
  request_.settings.bloom.strength = 0.0f;
  EXPECT_LE(DifferentFromEachAlone(), 4);
}

TEST_F(Crowd, EachHasItsOwnFace) {
  request_.settings.view = View::kWeights;
  std::vector<PosedSubject> same = drawn_;
  for (PosedSubject& subject : same) {
    subject.wrinkle_weights = people_[2].weights;
    subject.filtered_values = people_[2].driver_values;
  }
  EXPECT_GT(test::NumDifferent(Draw(drawn_), Draw(same), 10), 100);
}

// A single mesh that contains all subjects at rest, where a crowd has one mesh several times.
character::Character Merged(const character::Character& head) {
  character::Character merged = head;
  character::Mesh& mesh = merged.meshes[0];
  mesh.vertices.clear();
  mesh.indices.clear();
  for (int i = 0; i < kNumPeople; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const glm::mat3 turn = glm::mat3(Spot(i)) / glm::length(glm::vec3(Spot(i)[0]));
    for (character::Vertex vertex : head.meshes[0].vertices) {
      vertex.position = glm::vec3(Spot(i) * glm::vec4(vertex.position, 1.0f));
      vertex.normal = turn * vertex.normal;
      vertex.tangent = glm::vec4(turn * glm::vec3(vertex.tangent), vertex.tangent.w);
      mesh.vertices.push_back(vertex);
    }
    for (const std::uint32_t index : head.meshes[0].indices) mesh.indices.push_back(first + index);
  }
  return merged;
}

// Includes all effects between surfaces: shadows, occlusion and scattering.
TEST_F(Crowd, IsLitLikeOneMeshOfAll) {
  const test::Subject rest(head_);
  const character::Character merged = Merged(head_);
  for (const View view : {View::kShadow, View::kFinal}) {
    request_.settings.shading = Shading::kSkin;
    request_.settings.view = view;
    // A low lamp at the side: each subject is in the shadow of the next one.
    request_.camera.position = {0.9f, 1.6f, 1.3f};
    request_.settings.lights.preset = LightPreset::kHard;
    std::vector<PosedSubject> drawn;
    for (int i = 0; i < kNumPeople; ++i) drawn.push_back(DrawnAs(rest, Spot(i)));
    const Image crowd = Draw(drawn);
    const Image first_alone = Draw(std::span(drawn).first(1));
    auto renderer = test::Expect(Renderer::Create(merged));
    const test::Subject all(merged);
    static_cast<PosedSubject&>(request_) = DrawnAs(all, glm::mat4(1.0f));
    request_.others = {};
    const Image expected = test::Expect(renderer->Render(request_));
    EXPECT_LE(test::NumDifferent(crowd, expected, 2), 12) << ViewName(view);
    EXPECT_GT(test::NumDifferent(first_alone, expected, 2), 1000);
  }
}

TEST_F(Crowd, DisplacesEachByItsOwnWeights) {
  character::Character head = head_;
  head.pictures.push_back(test::MakePicture(
      "bumps", 64, [](float u, float v) { return glm::vec4(0.5f + 0.5f * u * v); }));
  head.rig_pictures.emplace_back("bumps", static_cast<int>(head.pictures.size()) - 1);
  for (wrinkle::WrinkleMap& map : head.rig.wrinkle_maps) {
    map.height = "bumps";
    map.height_mm = 8.0f;
  }
  renderer_ = test::Expect(Renderer::Create(head));
  request_.settings.displacement.enabled = true;
  request_.settings.lights.preset = LightPreset::kHard;  // shows small heights
  EXPECT_EQ(DifferentFromEachAlone(), 0);
  const Image raised = Draw(drawn_);
  request_.settings.displacement.enabled = false;
  EXPECT_GT(test::NumDifferent(raised, Draw(drawn_), 10), 100);
}

// Simplified meshes may move outlines by about a pixel and must change little else.
TEST_F(Crowd, SmallSubjectsLookTheSameWithFewerTriangles) {
  const Image full = Draw(drawn_);
  request_.settings.detail.error_pixels = 0.5f;
  const Image simplified = Draw(drawn_);
  EXPECT_GT(test::NumDifferent(full, simplified, 0), 0);
  EXPECT_LT(test::NumDifferent(full, simplified, 24), kCrowdWidth * kCrowdHeight / 100);
  const Image alone = Draw(std::span(drawn_).first(1));
  request_.settings.detail.error_pixels = 0.0f;
  EXPECT_EQ(test::NumDifferent(alone, Draw(std::span(drawn_).first(1)), 0), 0);
}

// Shadow edges may move by a fraction of a texel, and no surface may shade itself.
TEST_F(Crowd, SimplifiedHairCastsTheSameShadows) {
  character::Character head = head_;
  for (character::Material& material : head.materials) {
    material.kind = character::Material::Kind::kHair;
  }
  renderer_ = test::Expect(Renderer::Create(head));
  request_.settings.view = View::kShadow;
  request_.settings.detail.hair_shadow_texels = 0.0f;
  const Image full = Draw(drawn_);
  request_.settings.detail.hair_shadow_texels = 1.0f;
  const Image simplified = Draw(drawn_);
  EXPECT_GT(test::NumDifferent(full, simplified, 0), 0);
  EXPECT_LT(test::NumDifferent(full, simplified, 24), kCrowdWidth * kCrowdHeight / 200);
  request_.settings.shadow.normal_offset_mm = 0.0f;  // no offset hides an error
  const Image exact = Draw(drawn_);
  request_.settings.detail.hair_shadow_texels = 0.0f;
  EXPECT_EQ(test::NumDifferent(exact, Draw(drawn_), 0), 0);
}

TEST_F(Crowd, TheCameraFollowsTheFirst) {
  request_.camera = *renderer_->Preset("face");
  const PosedSubject home = DrawnAs(people_[0], glm::mat4(1.0f));
  const PosedSubject away =
      DrawnAs(people_[0], glm::translate(glm::mat4(1.0f), {3.0f, 1.0f, 2.0f}));
  EXPECT_EQ(test::NumDifferent(Draw(std::span(&home, 1)), Draw(std::span(&away, 1)), 4), 0);
}

TEST_F(Crowd, TooManyVerticesAreRejected) {
  character::Character fine = test::MakePlane(4, [](float, float) { return 0.0f; }, {});
  character::Mesh& mesh = fine.meshes[0];
  mesh.vertices.resize(70'000, mesh.vertices.front());
  renderer_ = test::Expect(Renderer::Create(fine));
  const test::Subject subject(fine);
  const std::vector<PosedSubject> many(kMaxSubjects, DrawnAs(subject, glm::mat4(1.0f)));
  static_cast<PosedSubject&>(request_) = many.front();
  request_.others = std::span(many).subspan(1);
  request_.camera.target = glm::vec3(0.0f);
  const Status status = renderer_->Submit(request_);
  EXPECT_EQ(status.code(), StatusCode::kLimit) << status.ToString();
  EXPECT_NE(status.what().find("70000 vertices"), std::string::npos) << status.what();
}

}  // namespace
}  // namespace furrow::render
