// SPDX-License-Identifier: Apache-2.0
// Parts of meshes that no view sees are neither posed nor drawn, and no picture shows it.
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

// Two sheets of many clusters, one 10 cm before the other, so that each lamp casts the shadow of
// one on the other. The upper half follows the second joint.
character::Character MakeTwoSheets() {
  character::Character sheets = test::MakeSheet(64, 64);
  test::SetSkeleton({test::Joint("root", -1, glm::vec3(0.0f)),
                     test::Joint("top", 0, glm::vec3(0.0f, 0.2f, 0.0f))},
                    &sheets);
  for (character::Vertex& vertex : sheets.meshes[0].vertices) {
    if (vertex.position.y > 0.2f) vertex.joints[0] = 1;
  }
  character::Mesh front = sheets.meshes[0];
  front.name = "front";
  for (character::Vertex& vertex : front.vertices) {
    vertex.position = vertex.position * 0.4f + glm::vec3(0.1f, 0.1f, 0.1f);
  }
  sheets.meshes.push_back(std::move(front));
  return sheets;
}

Camera At(const glm::vec3& position, const glm::vec3& target) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  return camera;
}

class SeenParts : public testing::Test {
 protected:
  SeenParts() : renderer_(test::Expect(Renderer::Create(sheets_))) {
    request_.width = 160;
    request_.height = 100;
    request_.settings.shading = Shading::kSkin;
    request_.settings.detail.error_pixels = 0.0f;
    Pose(0.0f);
  }

  void Pose(float angle) {
    subject_.pose.joints[1].rotation = glm::angleAxis(angle, glm::vec3(1, 0, 0));
    subject_.Solve();
    request_.model = subject_.model;
  }

  // Beside a subject that is far away, nothing is left out.
  Image DrawWhole() {
    const PosedSubject away{subject_.model,
                            {},
                            nullptr,
                            {},
                            {},
                            glm::translate(glm::mat4(1.0f), glm::vec3(500.0f, 0.0f, -50.0f))};
    request_.others = std::span(&away, 1);
    Image image = test::Expect(renderer_->Render(request_));
    request_.others = {};
    return image;
  }

  const character::Character sheets_ = MakeTwoSheets();
  test::Subject subject_{sheets_};
  std::unique_ptr<Renderer> renderer_;
  FrameRequest request_;
};

TEST_F(SeenParts, ShowTheSamePictureFromEverywhere) {
  const Camera cameras[] = {
      At({0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}), At({0.2f, 0.1f, 0.8f}, {0.1f, 0.1f, 0.0f}),
      At({-0.9f, 0.8f, 0.5f}, {-0.5f, 0.3f, 0.0f}), At({0.4f, 0.9f, 0.3f}, {0.4f, 0.5f, 0.0f}),
      At({0.9f, -0.9f, 0.25f}, {0.9f, -0.85f, 0.0f})};
  for (const LightPreset lights : {LightPreset::kStudio, LightPreset::kThesis}) {
    request_.settings.lights.preset = lights;
    for (const ShadowFilter filter : {ShadowFilter::kPcf, ShadowFilter::kPcss}) {
      request_.settings.shadow.filter = filter;
      for (const Camera& camera : cameras) {
        request_.camera = camera;
        for (const float angle : {0.0f, 0.7f, -1.2f}) {
          Pose(angle);
          const Image parts = test::Expect(renderer_->Render(request_));
          const Image whole = DrawWhole();
          EXPECT_TRUE(parts.rgb == whole.rgb)
              << "camera at x = " << camera.position.x << ", angle " << angle;
        }
      }
    }
  }
}

// Turning the camera up and down moves no lamp, so the maps would be kept, but other casters count.
TEST_F(SeenParts, CountForTheShadowsOfAnotherCamera) {
  const float heights[] = {0.0f, 0.5f, -0.5f, 0.25f};
  const auto turn_to = [&](float height) {
    request_.camera = At({0.1f, 0.1f + height, 0.8f}, {0.1f, 0.1f, 0.0f});
  };
  std::vector<Image> parts;
  for (const float height : heights) {
    turn_to(height);
    parts.push_back(test::Expect(renderer_->Render(request_)));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    turn_to(heights[i]);
    EXPECT_TRUE(parts[i].rgb == DrawWhole().rgb) << "height " << heights[i];
  }
}

// Views of data, whose shadow maps show all casters.
TEST_F(SeenParts, ShowAllCastersInShadowMaps) {
  request_.camera = At({0.2f, 0.1f, 0.8f}, {0.1f, 0.1f, 0.0f});
  request_.settings.view = View::kShadowMaps;
  const Image parts = test::Expect(renderer_->Render(request_));
  EXPECT_TRUE(parts.rgb == DrawWhole().rgb);
}

// A camera that turns sees vertices that the former picture has not posed.
TEST_F(SeenParts, ContinueAStreamWhereverTheCameraTurns) {
  const auto renderer = test::Expect(Renderer::Create(sheets_));
  request_.is_moving = true;
  request_.stream = 1;
  request_.scale = 0.5f;
  Image last;
  for (int step = 0; step <= 12; ++step) {
    const float x = -0.6f + 0.1f * static_cast<float>(step);
    request_.camera = At({x, 0.1f, 0.8f}, {x, 0.1f, 0.0f});
    last = test::Expect(renderer->Render(request_));
  }
  request_.is_moving = false;
  request_.stream = 0;
  const Image still = test::Expect(renderer->Render(request_));
  double sum = 0.0;
  for (std::size_t i = 0; i < still.rgb.size(); ++i) {
    const double apart = double{1} * last.rgb[i] - still.rgb[i];
    sum += apart * apart;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(still.rgb.size())), 12.0);
}

}  // namespace
}  // namespace furrow::render
