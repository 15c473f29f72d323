// SPDX-License-Identifier: Apache-2.0
// The render thread with a fake renderer: what is drawn and encoded, and for whom.
#include "server/pipeline/render_thread.h"

#include <cstdint>
#include <latch>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/pipeline/fake_video.h"
#include "tests/unit/server/pipeline/render_thread_fixture.h"

namespace furrow::server {
namespace {

TEST_F(RenderThreadTest, TheRequestHasTheWeightsOfTheShapes) {
  Start();
  Submit(1);
  EXPECT_EQ(pictures.Take().sequence, 1u);
  const std::vector<std::string> stream = {"jawOpen"};
  const std::vector<std::string> face = {"cheekPuff", "jawOpen"};
  shape_program =
      std::make_shared<const wrinkle::ShapeProgram>(wrinkle::ShapeProgram::ByName(stream, face));
  Submit(2);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  thread.reset();
  EXPECT_EQ(script.shapes, (std::vector<std::vector<float>>{{}, {0.0f, 0.25f}}));
}

TEST_F(RenderThreadTest, StillsUseMoreSamplesIfTheSettingsAllow) {
  Start();
  render::Settings fixed;
  fixed.anti_aliasing.samples = 2;
  Submit(1, {.subscription = 1}, {});
  EXPECT_EQ(pictures.Take().encoding.quality, 85);
  Submit(2, {.subscription = 2, .still = true}, {});
  EXPECT_GE(pictures.Take().encoding.quality, 90);
  Submit(3, {.subscription = 3, .still = true}, fixed);
  (void)pictures.Take();
  thread.reset();
  EXPECT_EQ(script.samples, (std::deque<int>{0, kStillSamples, 2}));
}

// Only a renderer on the CPU saves work, and PNG shows every pixel as it was drawn.
TEST_F(RenderThreadTest, JpegOfAMovingSubjectMayBeInexactOnTheCpu) {
  script.is_software = true;
  Start();
  Submit(1, {.subscription = 1}, {});
  (void)pictures.Take();
  Submit(2, {.subscription = 2, .still = true}, {});
  (void)pictures.Take();
  Submit(3, {.subscription = 3, .encoding = {.format = render::ImageFormat::kPng}}, {});
  (void)pictures.Take();
  thread.reset();
  EXPECT_EQ(script.moving, (std::deque<bool>{true, false, false}));
}

TEST_F(RenderThreadTest, MovingPicturesContinueTheStreamOfTheirViewer) {
  script.is_software = true;
  Start();
  render::Settings skin;
  skin.shading = render::Shading::kSkin;
  const auto draw = [&, settings = std::make_shared<const render::Settings>(skin)](
                        const RenderJob& from, const PictureTicket& ticket) {
    RenderJob job = from;
    job.tickets = {ticket};
    job.spec.settings = settings;
    thread->Submit(std::move(job));
    return pictures.Take();
  };
  const RenderJob job = JobOf(1);
  EXPECT_EQ(draw(job, {.subscription = 1, .acknowledges = true}).drawn_percent, 75)
      << "as the renderer says";
  (void)draw(job, {.subscription = 1, .acknowledges = true});
  (void)draw(job, {.subscription = 2, .acknowledges = true});
  (void)draw(job, {.subscription = 1, .still = true});
  (void)draw(job, {.subscription = 1, .encoding = {.format = render::ImageFormat::kPng}});
  (void)draw(JobOf(2), {.subscription = 1, .acknowledges = true});  // another subject
  (void)draw(job, {.subscription = 3});  // nothing would refine it at rest
  render::Settings diffuse;
  Submit(1, {.subscription = 1, .acknowledges = true}, diffuse);
  (void)pictures.Take();
  thread.reset();
  const std::deque<std::uint64_t>& streams = script.streams;
  ASSERT_EQ(streams.size(), 8u);
  EXPECT_NE(streams[0], 0u);
  EXPECT_EQ(streams[1], streams[0]);
  EXPECT_NE(streams[2], streams[0]);
  EXPECT_EQ(streams[3], 0u);
  EXPECT_EQ(streams[4], 0u);
  EXPECT_NE(streams[5], 0u);
  EXPECT_NE(streams[5], streams[0]);
  EXPECT_EQ(streams[6], 0u);
  EXPECT_EQ(streams[7], 0u) << "diffuse shading is not completed";
}

TEST_F(RenderThreadTest, PicturesOfAGpuAreExact) {
  Start();
  Submit(1, {.subscription = 1}, {});
  (void)pictures.Take();
  thread.reset();
  EXPECT_EQ(script.moving, (std::deque<bool>{false}));
  EXPECT_EQ(script.streams, (std::deque<std::uint64_t>{0}));
}

TEST_F(RenderThreadTest, APictureWhoseViewerHasLeftIsNotEncoded) {
  std::latch go_on(1), holds(1);
  script.hold_first_submit = &go_on;
  script.in_first_submit = &holds;
  Start();
  Submit(1);
  holds.wait();
  thread->Withdraw(1);
  Submit(2);
  thread->Withdraw(2);  // not even drawn
  go_on.count_down();
  Submit(3);
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_EQ(Count(Counter::kPicturesEncoded), 1u);
  EXPECT_EQ(Count(Counter::kPicturesRendered), 2u);
  EXPECT_EQ(Count(Counter::kPicturesWithdrawn), 2u);
}

TEST_F(RenderThreadTest, APictureThatNobodyWantsAnyMoreIsAbandoned) {
  script.passes = 3;
  bool is_first = true;
  std::optional<PictureSource::Drawing> seen;
  script.on_pass = [&](int pass) {
    if (pass != 1 || !std::exchange(is_first, false)) return;
    seen = thread->drawing();
    EXPECT_TRUE(thread->WithdrawStill(1));
  };
  Start();
  Submit(1, {.subscription = 1, .still = true}, {});
  Submit(2);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  ASSERT_TRUE(seen.has_value());
  EXPECT_EQ(seen->done, 1);
  EXPECT_EQ(seen->passes, 3);
  EXPECT_FALSE(thread->drawing().has_value());
  EXPECT_EQ(Count(Counter::kPicturesRendered), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 0u);
  EXPECT_EQ(script.num_created, 1) << "the context is not lost";
}

TEST_F(RenderThreadTest, PreparationsAreDrawnForNobodyAndGoOnAfterAPicture) {
  script.passes = 2;
  std::latch prepared(1);
  int passes = 0;
  script.on_pass = [&](int pass) {
    // The first pass of the first preparation: a viewer comes.
    if (++passes == 1) Submit(1);
    // Preparation, abandoned; picture; preparation, complete.
    if (passes == 5 && pass == 1) prepared.count_down();
  };
  Start();
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->retarget =
      std::make_shared<const wrinkle::Retarget>(wrinkle::Retarget::Create(skeleton, skeleton));
  snapshot->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>();
  snapshot->joints.assign(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  RenderJob job;
  job.spec = {.width = 16, .height = 16};
  job.snapshot = std::move(snapshot);
  thread->Prepare({std::move(job)});
  EXPECT_EQ(pictures.Take().sequence, 1u);
  prepared.wait();
  thread.reset();
  EXPECT_EQ(script.samples.size(), 2u) << "the picture, and the preparation";
  EXPECT_EQ(Count(Counter::kPicturesRendered), 1u);
  EXPECT_EQ(pictures.num_failed_tickets(), 0u);
}

TEST_F(RenderThreadTest, TheEncodingsOfAPictureAreLimited) {
  Start();
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->retarget =
      std::make_shared<const wrinkle::Retarget>(wrinkle::Retarget::Create(skeleton, skeleton));
  snapshot->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>();
  snapshot->joints.assign(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  RenderJob job{1, {.width = 16, .height = 16}, std::move(snapshot), {}};
  for (int quality = 1; quality <= 100; ++quality) {
    job.tickets.push_back({.subscription = static_cast<std::uint64_t>(quality),
                           .encoding = {render::ImageFormat::kJpeg, quality}});
  }
  job.tickets.push_back({.subscription = 101, .encoding = {render::ImageFormat::kPng, 0}});
  thread->Submit(std::move(job));
  std::size_t viewers = 0;
  std::size_t encodings = 0;
  while (viewers < 101) {
    const FinishedPicture picture = pictures.Take();
    viewers += picture.tickets.size();
    ++encodings;
    for (const PictureTicket& ticket : picture.tickets) {
      EXPECT_EQ(ticket.encoding.format, picture.encoding.format);
    }
  }
  EXPECT_EQ(encodings, PictureEncoder::kMaxEncodings + 1) << "and one PNG";
}

// Two viewers with video, one of a still and one without: one picture, three encodings.
TEST_F(RenderThreadTest, ViewersWithVideoHaveTheirOwnEncoders) {
  test::fake_video = {};
  VideoEncoders encoders(test::FakeVideoCodec(), 8);
  Start(&encoders);
  const render::VideoFormat format{16, 16, 80};
  for (const std::uint64_t viewer : {1, 2, 3}) {
    ASSERT_TRUE(thread->OpenVideo(viewer, std::to_string(viewer), format));
  }
  for (int picture = 0; picture < 2; ++picture) {
    RenderJob job = JobOf(1);
    const render::VideoTarget target{.key = picture == 1};
    job.tickets = {{.subscription = 1, .video = target},
                   {.subscription = 2, .video = render::VideoTarget()},
                   {.subscription = 3, .still = true, .video = target},
                   {.subscription = 4},
                   {.subscription = 5, .video = target}};  // its encoder has gone
    thread->Submit(std::move(job));
    std::map<std::uint64_t, FinishedPicture> got;
    while (got.size() < 5) {
      const FinishedPicture taken = pictures.Take();
      for (const PictureTicket& ticket : taken.tickets) got.emplace(ticket.subscription, taken);
    }
    EXPECT_EQ(got[1].codec, "avc1.42c01e");
    EXPECT_TRUE(got[1].key);
    EXPECT_EQ(got[2].codec, "avc1.42c01e");
    EXPECT_EQ(got[2].key, picture == 0);
    for (const std::uint64_t viewer : {3, 4, 5}) {
      EXPECT_EQ(got[viewer].codec, "") << viewer;
      EXPECT_EQ(got[viewer].bytes.at(0), 0xFF) << "JPEG";
    }
  }
  EXPECT_EQ(Count(Counter::kPicturesRendered), 2u);
  EXPECT_EQ(Count(Counter::kVideoPictures), 4u);
  EXPECT_EQ(Count(Counter::kVideoKeyPictures), 3u);
  thread->Withdraw(1);
  EXPECT_EQ(encoders.state().encoders, 2);
  thread.reset();
}

}  // namespace
}  // namespace furrow::server
