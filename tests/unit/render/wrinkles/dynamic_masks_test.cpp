// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/dynamic_masks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

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
                .driver = "nod",
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
  const auto frame = wrinkle::RestSlidingFrame(
      head.rig.drivers.back(), head.rig.regions.back().feeds.front(), head.skeleton);
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
    const glm::vec3 towards =
        wrinkle::BendDirection(*frame, std::array{front, 0.0f, 0.6f - front, 0.0f});
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

// The mask of the tests' head after the value `value` of its driver has become 0.5.
std::vector<DynamicMaskBlock> BlocksOf(character::Character head, const std::string& value) {
  head.rig.regions.back().feeds = {{"folds", {{"nod", value, 1.0f}}}};
  test::Subject subject(head);
  std::ranges::fill(subject.driver_values, 0.0f);
  std::ranges::fill(subject.weights, 0.0f);
  const auto names = subject.binding.driver_value_names();
  const auto at = std::ranges::find(names, "nod." + value) - names.begin();
  subject.driver_values[static_cast<std::size_t>(at)] = 0.5f;
  subject.weights.back() = 0.8f;
  DynamicMasks masks(&subject.binding, &subject.binding);
  masks.Update(MaskMode::kRig, subject.driver_values, subject.weights);
  std::vector<DynamicMaskBlock> blocks;
  for (std::size_t map = 0; map < head.rig.wrinkle_maps.size(); ++map) {
    masks.Append(static_cast<int>(map), &blocks);
  }
  return blocks;
}

// The head is above the root: about +x it nods forward, about +y its front turns to its left.
TEST(SlidingMask, FollowsHingesAndTwists) {
  character::Character head = MakeSlidingHead();
  wrinkle::Driver& nod = head.rig.drivers.back();
  nod.kind = wrinkle::Driver::Kind::kHinge;
  nod.hinge.parent = "root";
  nod.hinge.joint = "head";
  nod.hinge.end = "brow";
  nod.hinge.axis = glm::vec3(1.0f, 0.0f, 0.0f);
  const auto expect = [&](const char* value, const glm::vec3& towards) {
    const std::vector<DynamicMaskBlock> blocks = BlocksOf(head, value);
    ASSERT_EQ(blocks.size(), 1u) << value;
    EXPECT_EQ(blocks[0].column, -1);
    EXPECT_EQ(blocks[0].origin.w, 0.8f);
    EXPECT_GT(glm::dot(glm::vec3(blocks[0].towards), towards), 0.999f) << value;
  };
  expect("flexed", {0.0f, 0.0f, 1.0f});
  expect("extended", {0.0f, 0.0f, -1.0f});
  nod.kind = wrinkle::Driver::Kind::kTwist;
  nod.twist.joint = "head";
  nod.twist.axis = glm::vec3(0.0f, 1.0f, 0.0f);
  expect("twist_left", {1.0f, 0.0f, 0.0f});
  expect("twist_right", {-1.0f, 0.0f, 0.0f});
}

}  // namespace
}  // namespace furrow::render
