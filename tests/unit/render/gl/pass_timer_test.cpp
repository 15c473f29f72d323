// SPDX-License-Identifier: Apache-2.0
#include "render/gl/pass_timer.h"

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

TEST(PassTimer, TimesThePassesOfAFrameInOrder) {
  const character::Character head = test::MakeHead();
  auto renderer = Renderer::Create(head);
  ASSERT_TRUE(renderer.ok()) << renderer.status().ToString();
  const test::Subject subject(head);
  FrameRequest request;
  request.model = subject.model;
  request.camera = *(*renderer)->Preset("face");
  request.width = request.height = 64;
  PassTimer timer;
  (*renderer)->SetObserver(&timer);
  ASSERT_TRUE((*renderer)->Render(request).ok());
  const std::vector<PassTime> times = timer.Take();
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].pass, "scene");
  EXPECT_EQ(times[1].pass, "composite");
  EXPECT_EQ(times[2].pass, "read back");
  double cpu_ms = 0.0;
  for (const PassTime& time : times) {
    EXPECT_GT(time.wall_ms, 0.0) << time.pass;
    EXPECT_GE(time.gpu_ms, 0.0) << time.pass;
    cpu_ms += time.cpu_ms;
  }
  EXPECT_GT(cpu_ms, 0.0);
  EXPECT_TRUE(timer.Take().empty());
  (*renderer)->SetObserver(nullptr);
  ASSERT_TRUE((*renderer)->Render(request).ok());
  EXPECT_TRUE(timer.Take().empty());
}

}  // namespace
}  // namespace furrow::render
