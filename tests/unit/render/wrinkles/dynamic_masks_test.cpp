// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/dynamic_masks.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/request/camera_preset.h"
#include "render/scene/camera_frame.h"
#include "tests/unit/render/scene_probe.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kSize = 256;

// The tests' head with a mask that slides around its central joint, which is a ball joint of the
// root.
character::Character MakeSlidingHead() {
  character::Character head = test::MakeHead();
  wrinkle::Driver nod;
  nod.name = "nod";
  nod.kind = wrinkle::Driver::Kind::kBall;
  nod.ball.parent = "root";
  nod.ball.joint = "head";
  nod.ball.end = "brow";
  head.rig.drivers.push_back(nod);
  wrinkle::Region slide;
  slide.name = "slide";
  slide.combine = wrinkle::Combine::kSum;
  slide.mask = {.kind = wrinkle::Mask::Kind::kSliding,
                .texture = {},
                .ball = "nod",
                .spread_degrees = 80.0f,
                .above = 2.0f,
                .below = 2.0f,
                .radius = 3.0f};
  slide.feeds = {{"folds",
                  {{"nod", "front", 1.0f},
                   {"nod", "back", 1.0f},
                   {"nod", "left", 1.0f},
                   {"nod", "right", 1.0f}}}};
  head.rig.regions.push_back(slide);
  return head;
}

// Bent by `front` and `left`, which are squares of a direction's cosine and sine.
test::Subject Bent(const character::Character& head, float front, float left) {
  test::Subject subject(head);
  std::ranges::fill(subject.driver_values, 0.0f);
  std::ranges::fill(subject.weights, 0.0f);
  const auto names = subject.binding.driver_value_names();
  const auto nod = std::ranges::find(names, "nod.front") - names.begin();
  subject.driver_values[static_cast<std::size_t>(nod)] = front;
  subject.driver_values[static_cast<std::size_t>(nod) + 2] = left;
  subject.weights.back() = 0.8f;
  return subject;
}

FrameRequest RequestOf(const test::Subject& subject) {
  FrameRequest request;
  request.model = subject.model;
  request.binding = &subject.binding;
  request.wrinkle_weights = subject.weights;
  request.filtered_values = subject.driver_values;
  request.settings.view = View::kMaskDynamic;
  request.width = request.height = kSize;
  return request;
}

TEST(SlidingMask, MatchesTheReference) {
  const character::Character head = MakeSlidingHead();
  const wrinkle::Mask& mask = head.rig.regions.back().mask;
  const auto frame = wrinkle::RestBallFrame(head.rig.drivers.back().ball, head.skeleton);
  ASSERT_TRUE(frame.has_value());
  test::SceneProbe probe(head);
  for (const float front : {0.0f, 0.3f, 0.6f}) {
    const test::Subject subject = Bent(head, front, 0.6f - front);
    FrameRequest request = RequestOf(subject);
    for (const auto& [name, camera] : CameraPresets(head)) {
      if (name == "three_quarter") request.camera = camera;
    }
    const std::vector<glm::vec4> pixels = probe.Draw(request);
    const float blue = probe.tables().table(WrinkleGroup::kSkin).maps.at(0).colour.b;
    const glm::vec3 towards = wrinkle::BendDirection(*frame, front, 0.0f, 0.6f - front, 0.0f);
    const CameraFrame camera = ComputeCamera(request.camera, head.skeleton, subject.model, 1.0f);
    int compared = 0;
    int masked = 0;
    for (const character::Vertex& vertex : head.meshes[0].vertices) {
      const glm::vec3 to_camera = glm::normalize(camera.position - vertex.position);
      if (glm::dot(vertex.normal, to_camera) < 0.5f) continue;
      const glm::vec4 clip = camera.view_projection * glm::vec4(vertex.position, 1.0f);
      const int x = static_cast<int>((clip.x / clip.w * 0.5f + 0.5f) * kSize);
      const int y = static_cast<int>((clip.y / clip.w * 0.5f + 0.5f) * kSize);
      const float expected = 0.8f * wrinkle::SlidingMaskAt(*frame, mask, towards, vertex.position);
      EXPECT_NEAR(pixels[static_cast<std::size_t>(y * kSize + x)].b / blue, expected, 0.05f);
      ++compared;
      masked += expected > 0.1f ? 1 : 0;
    }
    EXPECT_GT(compared, 200);
    EXPECT_GT(masked, 50);
  }
}

TEST(SlidingMask, IsInactiveAtWeight0AndWithTextureMasksOnly) {
  const character::Character head = MakeSlidingHead();
  test::SceneProbe probe(head);
  test::Subject subject = Bent(head, 0.5f, 0.0f);
  FrameRequest request = RequestOf(subject);
  (void)probe.Draw(request);
  ASSERT_EQ(probe.tables().table(WrinkleGroup::kSkin).dynamic_masks.size(), 1u);
  EXPECT_EQ(probe.tables().table(WrinkleGroup::kSkin).dynamic_masks[0].column, -1);
  request.settings.view = View::kFinal;
  request.settings.mask_mode = MaskMode::kTexture;
  (void)probe.Draw(request);
  EXPECT_TRUE(probe.tables().table(WrinkleGroup::kSkin).maps.empty());
  request.settings.mask_mode = MaskMode::kRig;
  subject.weights.back() = 0.0f;
  (void)probe.Draw(request);
  EXPECT_TRUE(probe.tables().table(WrinkleGroup::kSkin).maps.empty());
}

}  // namespace
}  // namespace furrow::render
