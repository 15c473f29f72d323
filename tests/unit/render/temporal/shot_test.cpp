// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/shot.h"

#include <functional>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

Shot AShot() {
  Shot shot{.width = 640, .height = 400};
  shot.camera.position = {0.0f, 1.6f, 1.0f};
  shot.camera.target = {0.0f, 1.6f, 0.0f};
  shot.camera.fov_y_degrees = 20.0f;
  return shot;
}

bool ContinuesAfter(const std::function<void(Shot*)>& change) {
  Shot next = AShot();
  change(&next);
  return Continues(AShot(), next);
}

TEST(Shot, GoesOnWhileOnlyThePoseChanges) {
  EXPECT_TRUE(ContinuesAfter([](Shot*) {}));
}

TEST(Shot, ASmallMoveOfTheCameraIsNoCut) {
  EXPECT_TRUE(ContinuesAfter([](Shot* s) { s->camera.position.x += 0.2f; }));
  EXPECT_TRUE(ContinuesAfter([](Shot* s) { s->camera.target.y -= 0.2f; }));
  EXPECT_TRUE(ContinuesAfter([](Shot* s) { s->camera.fov_y_degrees = 21.0f; }));
}

TEST(Shot, AJumpOfTheCameraIsACut) {
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.position.x += 0.3f; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.target.y -= 0.3f; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.fov_y_degrees = 24.0f; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.follow_joint = 2; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.turn_joint = 2; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->camera.fit_shorter_side = true; }));
}

TEST(Shot, AnotherSizeOrAnySettingIsACut) {
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->width = 641; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->height = 401; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->settings.view = View::kNormal; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->settings.wrinkles = false; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->settings.lights.turn_degrees = 1.0f; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->settings.shadow.taps = 9; }));
  EXPECT_FALSE(ContinuesAfter([](Shot* s) { s->settings.strip.views = {View::kNormal}; }));
}

FrameRequest MovingShot(std::uint64_t stream) {
  FrameRequest request;
  request.settings.shading = Shading::kSkin;
  request.is_moving = true;
  request.stream = stream;
  request.scale = 0.5f;
  return request;
}

TEST(IsCompleted, OnlyMovingPicturesOfAStreamWithSkin) {
  EXPECT_TRUE(IsCompleted(MovingShot(1), true));
  EXPECT_FALSE(IsCompleted(MovingShot(1), false)) << "a GPU";
  EXPECT_FALSE(IsCompleted(MovingShot(0), true)) << "no stream";
  EXPECT_TRUE(CanBeCompleted(MovingShot(0), true));
  FrameRequest full = MovingShot(1);
  full.scale = 1.0f;
  EXPECT_FALSE(IsCompleted(full, true)) << "at the full size";
  EXPECT_TRUE(CanBeCompleted(full, true));
  const auto changed = [](auto change) {
    FrameRequest request = MovingShot(1);
    change(request);
    EXPECT_EQ(IsCompleted(request, true), CanBeCompleted(request, true));
    return IsCompleted(request, true);
  };
  EXPECT_FALSE(changed([](FrameRequest& r) { r.is_moving = false; })) << "a still or a PNG";
  EXPECT_FALSE(changed([](FrameRequest& r) { r.settings.shading = Shading::kDiffuse; }));
  EXPECT_FALSE(changed([](FrameRequest& r) { r.settings.view = View::kDepth; }));
  EXPECT_FALSE(changed([](FrameRequest& r) { r.settings.anti_aliasing.samples = 1; }));
  EXPECT_FALSE(changed([](FrameRequest& r) { r.settings.displacement.enabled = true; }));
  EXPECT_FALSE(changed([](FrameRequest& r) { r.settings.strip.views = {View::kNormal}; }));
  const PosedSubject other;
  EXPECT_FALSE(changed([&](FrameRequest& r) { r.others = std::span(&other, 1); }));
}

}  // namespace
}  // namespace furrow::render
