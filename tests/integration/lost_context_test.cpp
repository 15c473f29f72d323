// SPDX-License-Identifier: Apache-2.0
// The render thread with a real OpenGL context that is lost while rendering.
#include "tests/unit/render/lost_context.h"

#include <array>
#include <future>
#include <memory>
#include <string>
#include <utility>

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include "character/package/package.h"
#include "motion/pose_source.h"
#include "server/net/clock.h"
#include "server/pipeline/render_thread.h"
#include "tests/log_capture.h"

namespace furrow::testing_net {
namespace {

using server::Counter;

// A renderer that loses its context before its second picture, as after a driver restart.
class ShortLived : public render::Renderer {
 public:
  explicit ShortLived(std::unique_ptr<render::Renderer> real) : real_(std::move(real)) {}
  Status Submit(const render::FrameRequest& request) override {
    if (submitted_++ == 1) render::test::DestroyCurrentContext();
    return real_->Submit(request);
  }
  Result<render::Image> Poll(bool wait) override { return real_->Poll(wait); }
  int in_flight() const override { return real_->in_flight(); }
  void SetObserver(render::FrameGraphObserver* observer) override { real_->SetObserver(observer); }
  std::string description() const override { return real_->description(); }
  Result<render::Camera> Preset(std::string_view name) const override {
    return real_->Preset(name);
  }

 private:
  std::unique_ptr<render::Renderer> real_;
  int submitted_ = 0;
};

class LostContext : public testing::Test {
 protected:
  void SetUp() override {
    auto loaded = character::LoadCharacter(FURROW_LIGHT_CHARACTER, {}, motion::CachedPoseSource());
    ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
    character = *std::move(loaded);
    auto started = server::RenderThread::Start(
        &character.skeleton, [this] { return Create(); }, &metrics, &server::ReadClock,
        [this](server::FinishedPicture picture) {
          drawn.at(num_drawn++).set_value(std::move(picture));
        });
    if (!started.ok()) GTEST_SKIP() << "no OpenGL 4.5 here: " << started.status().ToString();
    thread = *std::move(started);
  }
  Result<std::unique_ptr<render::Renderer>> Create() {
    auto real = render::Renderer::Create(character);
    if (!real.ok() || ++num_created > 1) return real;
    return std::unique_ptr<render::Renderer>(std::make_unique<ShortLived>(*std::move(real)));
  }
  void Submit(std::uint32_t number) {
    auto snapshot = std::make_shared<server::Snapshot>();
    snapshot->sequence = number;
    snapshot->retarget = std::make_shared<const wrinkle::Retarget>(
        wrinkle::Retarget::Create(character.skeleton, character.skeleton));
    snapshot->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>();
    snapshot->joints.assign(character.skeleton.rest_pose().begin(),
                            character.skeleton.rest_pose().end());
    server::RenderJob job{number, {.width = 64, .height = 64}, std::move(snapshot), {{number, {}}}};
    job.spec.camera = *thread->Preset("face");
    thread->Submit(std::move(job));
  }
  character::Character character;
  LogCapture log;
  server::Metrics metrics;
  std::array<std::promise<server::FinishedPicture>, 3> drawn;
  std::size_t num_drawn = 0;  // both used by the render thread
  int num_created = 0;
  std::unique_ptr<server::RenderThread> thread;  // destroyed first
};

TEST_F(LostContext, PicturesContinueAndTheLossIsLogged) {
  Submit(1);
  const server::FinishedPicture before = drawn[0].get_future().get();
  ASSERT_EQ(before.sequence, 1u);
  Submit(2);  // lost with the context
  const server::FinishedPicture lost = drawn[1].get_future().get();
  EXPECT_EQ(lost.sequence, 2u);
  EXPECT_TRUE(lost.bytes.empty());
  Submit(3);
  const server::FinishedPicture after = drawn[2].get_future().get();
  EXPECT_EQ(after.sequence, 3u);
  EXPECT_EQ(after.bytes, before.bytes);  // the same pose gives the same picture
  EXPECT_EQ(metrics.Get(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(metrics.Get(Counter::kPicturesFailed), 1u);
  EXPECT_EQ(metrics.Get(Counter::kPicturesRendered), 2u);
  thread.reset();
  EXPECT_NE(log.text().find("the renderer failed and will be created again"), std::string::npos);
  EXPECT_NE(log.text().find("rendering again on"), std::string::npos) << log.text();
}

}  // namespace
}  // namespace furrow::testing_net
