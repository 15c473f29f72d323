// SPDX-License-Identifier: Apache-2.0
// The render thread with a fake renderer that fails on demand.
#include "server/pipeline/render_thread.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <latch>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "base/status.h"
#include "tests/log_capture.h"
#include "tests/unit/server/pipeline/fake_video.h"

namespace furrow::server {
namespace {

const Status kLost(StatusCode::kUnavailable, "the context was lost");

// The results of the fake renderers in the order of the calls; further calls succeed. Used by the
// render thread only.
struct Script {
  std::deque<Status> create;
  std::deque<Status> submit;
  std::deque<Status> poll;
  std::latch* hold_first_submit = nullptr;
  std::latch* in_first_submit = nullptr;  // counted down when it holds
  int passes = 0;                         // of each picture, for the observer
  std::function<void(int)> on_pass;       // called in each pass
  int out_of_memory_submits = 0;          // the next calls throw
  int out_of_memory_polls = 0;
  std::deque<int> samples;                 // of the rendered requests
  std::deque<bool> moving;                 // the same
  std::deque<std::uint64_t> streams;       // the same
  std::vector<std::vector<float>> shapes;  // of the same
  int num_created = 0;
  bool is_software = false;

  static Status Next(std::deque<Status>* of) {
    if (of->empty()) return {};
    const Status status = of->front();
    of->pop_front();
    return status;
  }
};

class ScriptedRenderer : public render::Renderer {
 public:
  explicit ScriptedRenderer(Script* script) : script_(script) {}
  Status Submit(const render::FrameRequest& request) override {
    if (auto* latch = std::exchange(script_->in_first_submit, nullptr)) latch->count_down();
    if (auto* latch = std::exchange(script_->hold_first_submit, nullptr)) latch->wait();
    if (script_->out_of_memory_submits > 0) {
      --script_->out_of_memory_submits;
      throw std::bad_alloc();
    }
    FURROW_RETURN_IF_ERROR(DrawPasses());
    Status status = Script::Next(&script_->submit);
    if (status.ok()) ++in_flight_;
    if (status.ok()) script_->samples.push_back(request.settings.anti_aliasing.samples);
    if (status.ok()) script_->moving.push_back(request.is_moving);
    if (status.ok()) script_->streams.push_back(request.stream);
    if (status.ok()) script_->shapes.emplace_back(request.shapes.begin(), request.shapes.end());
    return status;
  }
  Result<render::Image> Poll(bool) override {
    if (script_->out_of_memory_polls > 0) {
      --script_->out_of_memory_polls;
      throw std::bad_alloc();
    }
    FURROW_RETURN_IF_ERROR(Script::Next(&script_->poll));
    if (in_flight_ == 0) return render::Image();
    --in_flight_;
    return render::Image{16, 16, std::vector<std::uint8_t>(16 * 16 * 3), 0, 75};
  }
  int in_flight() const override { return in_flight_; }
  bool is_software() const override { return script_->is_software; }
  void SetObserver(render::FrameGraphObserver* observer) override { observer_ = observer; }
  std::string description() const override { return "scripted"; }
  Result<render::Camera> Preset(std::string_view) const override { return render::Camera(); }

 private:
  Status DrawPasses() {
    if (script_->passes == 0) return {};
    observer_->BeginFrame(script_->passes);
    for (int pass = 0; pass < script_->passes; ++pass) {
      if (!observer_->Continues()) return {StatusCode::kUnavailable, "abandoned"};
      observer_->BeforePass("pass");
      if (script_->on_pass) script_->on_pass(pass);
      observer_->AfterPass("pass", {});
    }
    return {};
  }

  Script* script_;
  render::FrameGraphObserver* observer_ = nullptr;
  int in_flight_ = 0;
};

// Receives pictures. Take() blocks until the next rendered one and counts the failed ones.
class Pictures {
 public:
  void Put(FinishedPicture picture) {
    const std::lock_guard lock(mutex_);
    if (picture.bytes.empty()) {
      num_failed_tickets_ += picture.tickets.size();
      return;
    }
    pictures_.push_back(std::move(picture));
    changed_.notify_one();
  }
  FinishedPicture Take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !pictures_.empty(); });
    FinishedPicture picture = std::move(pictures_.front());
    pictures_.pop_front();
    return picture;
  }

  std::size_t num_failed_tickets() {
    const std::lock_guard lock(mutex_);
    return num_failed_tickets_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t num_failed_tickets_ = 0;
  std::deque<FinishedPicture> pictures_;
};

// Each look at the clock is a millisecond later.
Time Now() {
  static std::atomic<std::int64_t> looks = 0;
  return std::chrono::milliseconds(++looks);
}

class RenderThreadTest : public testing::Test {
 protected:
  void Start(VideoEncoders* video = nullptr) {
    auto started = RenderThread::Start(
        &skeleton, [this] { return Create(); }, &metrics, &Now,
        [this](FinishedPicture picture) { pictures.Put(std::move(picture)); }, video);
    ASSERT_TRUE(started.ok()) << started.status().ToString();
    thread = *std::move(started);
  }
  void StartLater(RenderThread::Factory whole, RenderThread::Factory draft,
                  std::promise<Status>* started) {
    thread = RenderThread::StartLater(
        &skeleton, std::move(whole), &metrics, &Now,
        [this](FinishedPicture picture) { pictures.Put(std::move(picture)); }, nullptr,
        {.presets = {{"face", render::Camera()}},
         .draft = std::move(draft),
         .on_started = [started](const Status& status) { started->set_value(status); }});
  }
  Result<std::unique_ptr<render::Renderer>> Create() {
    FURROW_RETURN_IF_ERROR(Script::Next(&script.create));
    ++script.num_created;
    return std::unique_ptr<render::Renderer>(std::make_unique<ScriptedRenderer>(&script));
  }
  // Submits a job with its own subject, so that no job replaces another. The pose has the same
  // number.
  void Submit(std::uint32_t number) { Submit(number, {.subscription = number}, {}); }
  void Submit(std::uint32_t number, const PictureTicket& ticket, const render::Settings& settings) {
    RenderJob job = JobOf(number);
    job.spec.settings = std::make_shared<const render::Settings>(settings);
    job.tickets = {ticket};
    thread->Submit(std::move(job));
  }
  // A job without tickets.
  RenderJob JobOf(std::uint32_t number) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sequence = number;
    snapshot->retarget =
        std::make_shared<const wrinkle::Retarget>(wrinkle::Retarget::Create(skeleton, skeleton));
    snapshot->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>();
    snapshot->shape_program = shape_program;
    snapshot->blend_shapes = {0.25f};
    snapshot->joints.assign(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
    return {number, {.width = 16, .height = 16}, std::move(snapshot), {}};
  }
  std::uint64_t Count(Counter counter) const { return metrics.Get(counter); }

  wrinkle::Skeleton skeleton =
      wrinkle::Skeleton::Create({{.name = "head", .parent = wrinkle::kNoJoint}}).value();
  std::shared_ptr<const wrinkle::ShapeProgram> shape_program;  // of the next snapshots
  Script script;
  Metrics metrics;
  Pictures pictures;
  std::unique_ptr<RenderThread> thread;  // destroyed first
};

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

TEST_F(RenderThreadTest, JobsWaitForARendererThatStartsLater) {
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      nullptr, &started);
  EXPECT_FALSE(thread->is_stuck());
  EXPECT_TRUE(thread->is_starting());
  EXPECT_EQ(thread->description(), "starting");
  EXPECT_EQ(thread->fault(), "");
  EXPECT_TRUE(thread->Preset("face").ok());
  EXPECT_EQ(thread->Preset("moon").status().code(), StatusCode::kNotFound);
  Submit(1);
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  EXPECT_FALSE(thread->is_starting());
  EXPECT_NE(thread->description(), "starting");
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(pictures.num_failed_tickets(), 0u);
}

TEST_F(RenderThreadTest, ARendererThatFailsToStartLaterRefusesAllJobs) {
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [&may_start]() -> Result<std::unique_ptr<render::Renderer>> {
        may_start.get_future().wait();
        return kLost;
      },
      nullptr, &started);
  Submit(1);
  may_start.set_value();
  EXPECT_FALSE(started.get_future().get().ok());
  EXPECT_EQ(pictures.num_failed_tickets(), 1u);
  EXPECT_TRUE(thread->is_stuck());
  EXPECT_FALSE(thread->is_starting());
  EXPECT_EQ(thread->Preset("face").status().code(), StatusCode::kInternal);
  EXPECT_EQ(thread->fault(), "the renderer could not start");
  Submit(2);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u);
}

TEST_F(RenderThreadTest, ViewersWithFlowControlSeeADraftFirst) {
  Script draft;
  draft.is_software = true;
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      [&draft] {
        return Result<std::unique_ptr<render::Renderer>>(
            std::make_unique<ScriptedRenderer>(&draft));
      },
      &started);
  Submit(1);  // without flow control, it waits for the whole character
  Submit(2, {.subscription = 2, .still = true, .acknowledges = true}, {});
  Submit(3, {.subscription = 3, .acknowledges = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_TRUE(thread->is_starting());
  EXPECT_EQ(draft.samples.size(), 1u);
  EXPECT_EQ(draft.streams, std::deque<std::uint64_t>{0});  // no program for completed pictures
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_FALSE(thread->is_starting());
  EXPECT_EQ(draft.samples.size(), 1u);
  thread.reset();
  EXPECT_EQ(script.samples.size(), 2u);
}

TEST_F(RenderThreadTest, WithoutASoftwareRendererOrWithAFaultyDraftJobsWait) {
  for (const bool has_draft : {false, true}) {
    Script draft;  // of a GPU
    std::promise<void> may_start;
    std::promise<Status> started;
    StartLater(
        [this, &may_start] {
          may_start.get_future().wait();
          return Create();
        },
        [&draft, has_draft]() -> Result<std::unique_ptr<render::Renderer>> {
          if (!has_draft) return kLost;
          return std::unique_ptr<render::Renderer>(std::make_unique<ScriptedRenderer>(&draft));
        },
        &started);
    Submit(1, {.subscription = 1, .acknowledges = true}, {});
    may_start.set_value();
    EXPECT_TRUE(started.get_future().get().ok());
    EXPECT_EQ(pictures.Take().sequence, 1u);
    EXPECT_TRUE(draft.samples.empty());
    thread.reset();
  }
}

TEST_F(RenderThreadTest, ADraftThatIsLostIsNotDrawnAgain) {
  Script draft;
  draft.is_software = true;
  draft.submit = {kLost};
  std::latch in_submit(1);
  draft.in_first_submit = &in_submit;
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      [&draft] {
        return Result<std::unique_ptr<render::Renderer>>(
            std::make_unique<ScriptedRenderer>(&draft));
      },
      &started);
  Submit(1, {.subscription = 1, .acknowledges = true}, {});
  in_submit.wait();
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  Submit(2, {.subscription = 2, .acknowledges = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_EQ(script.num_created, 1);
}

TEST_F(RenderThreadTest, ALostContextIsCreatedAgain) {
  script.submit = {Status(), kLost};
  Start();
  Submit(1);
  EXPECT_EQ(pictures.Take().sequence, 1u);
  Submit(2);  // lost
  Submit(3);
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_EQ(script.num_created, 2);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
  EXPECT_EQ(Count(Counter::kPicturesRendered), 2u);
}

TEST_F(RenderThreadTest, PicturesInFlightFailWithTheContext) {
  std::latch both_wait(1);
  script.hold_first_submit = &both_wait;
  script.poll = {kLost};
  Start();
  Submit(1);
  Submit(2);
  both_wait.count_down();
  Submit(3);
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 2u);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u);  // failures are delivered
}

TEST_F(RenderThreadTest, AttemptsBecomeRarerWhileCreationFails) {
  script.create = {Status(), kLost, kLost};
  script.submit = {kLost};
  Start();
  // Job 1 loses the context. Creation fails for job 2, so job 3 is skipped; it fails again for job
  // 4, so three more are skipped.
  for (std::uint32_t number = 1; number <= 8; ++number) Submit(number);
  EXPECT_EQ(pictures.Take().sequence, 8u);
  EXPECT_EQ(script.num_created, 2);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 7u);
  // After a success, the next loss is repaired at once.
  script.submit = {kLost};
  Submit(9);
  Submit(10);
  EXPECT_EQ(pictures.Take().sequence, 10u);
}

TEST_F(RenderThreadTest, AFailedJobDoesNotAffectOthers) {
  script.submit = {Status(StatusCode::kInvalidArgument, "no such size")};
  Start();
  Submit(1);
  Submit(2);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_EQ(script.num_created, 1);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 0u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
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

TEST_F(RenderThreadTest, LackOfMemoryCostsPicturesNotTheThread) {
  Start();
  script.out_of_memory_submits = 1;
  script.out_of_memory_polls = 1;
  // The first is lost while it is drawn, the second while it is read back.
  for (std::uint32_t number = 1; number <= 6; ++number) Submit(number);
  EXPECT_GE(pictures.Take().sequence, 3u);
  EXPECT_EQ(Count(Counter::kAllocationsFailed), 2u);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 2u);
}

TEST_F(RenderThreadTest, AStillThatNeedsTooMuchMemoryHasFewerSamples) {
  script.submit = {Status(StatusCode::kLimit, "too much")};
  Start();
  Submit(1, {.subscription = 1, .still = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 1u);
  thread.reset();
  EXPECT_EQ(script.samples, (std::deque<int>{0}));
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

TEST_F(RenderThreadTest, AnEncoderThatFailsLeavesJpeg) {
  test::fake_video = {.fails_after = 1};
  VideoEncoders encoders(test::FakeVideoCodec(), 8);
  const LogCapture log;
  Start(&encoders);
  ASSERT_TRUE(thread->OpenVideo(1, "a", {16, 16, 80}));
  std::vector<std::string> codecs;
  for (int picture = 0; picture < 3; ++picture) {
    RenderJob job = JobOf(1);
    job.tickets = {{.subscription = 1, .video = render::VideoTarget()}};
    thread->Submit(std::move(job));
    codecs.push_back(pictures.Take().codec);
  }
  EXPECT_EQ(codecs, (std::vector<std::string>{"avc1.42c01e", "", ""}));
  EXPECT_NE(log.text().find("the fake encoder failed"), std::string::npos) << log.text();
  EXPECT_FALSE(thread->OpenVideo(1, "a", {16, 16, 80}));
  thread.reset();
}

TEST_F(RenderThreadTest, ARendererThatDoesNotRespondTurnsPicturesOff) {
  std::latch go_on(1), holds(1);
  script.hold_first_submit = &go_on;
  script.in_first_submit = &holds;
  const LogCapture log;
  Start();
  Submit(1);
  holds.wait();
  Submit(2);  // waits
  const Time begun = FromSeconds(100);
  thread->Watch(begun);
  thread->Watch(begun + RenderThread::kStuckAfter - FromSeconds(1));
  EXPECT_FALSE(thread->is_stuck());
  thread->Watch(begun + RenderThread::kStuckAfter);
  EXPECT_TRUE(thread->is_stuck());
  EXPECT_EQ(pictures.num_failed_tickets(), 1u) << "the one that waits";
  Submit(3);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u) << "and each new one, at once";
  thread->Watch(begun + FromSeconds(1000));
  EXPECT_EQ(Count(Counter::kRendererStuck), 1u);
  EXPECT_NE(log.text().find("has not responded for 30 s"), std::string::npos) << log.text();
  // It comes back.
  go_on.count_down();
  EXPECT_EQ(pictures.Take().sequence, 1u);
  while (thread->is_stuck()) thread->Watch(begun + FromSeconds(1001));
  EXPECT_NE(log.text().find("the renderer responds again"), std::string::npos);
  Submit(4);
  EXPECT_EQ(pictures.Take().sequence, 4u);
}

TEST_F(RenderThreadTest, ALongFrameIsNotARendererThatHangs) {
  script.passes = 3;
  const Time begun = FromSeconds(100);
  script.on_pass = [&](int pass) {
    // Each pass takes almost as long as a renderer may be silent.
    thread->Watch(begun + pass * (RenderThread::kStuckAfter - FromSeconds(1)));
    EXPECT_FALSE(thread->is_stuck()) << "in pass " << pass;
  };
  Start();
  Submit(1);
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(Count(Counter::kRendererStuck), 0u);
}

TEST_F(RenderThreadTest, AfterStopNothingIsDrawn) {
  Start();
  thread->Stop();
  Submit(1);
  EXPECT_EQ(pictures.num_failed_tickets(), 1u);
  EXPECT_EQ(Count(Counter::kPicturesRendered), 0u);
}

// The factory holds the character, which is large.
TEST_F(RenderThreadTest, AfterStopTheFactoryIsGone) {
  auto character = std::make_shared<int>(0);
  const std::weak_ptr<int> watched = character;
  const auto started = RenderThread::Start(
      &skeleton, [this, held = std::move(character)] { return Create(); }, &metrics, &Now,
      [](FinishedPicture) {});
  ASSERT_TRUE(started.ok());
  EXPECT_FALSE((*started)->ended());
  EXPECT_FALSE(watched.expired());
  (*started)->Stop();
  while (!(*started)->ended()) std::this_thread::yield();
  EXPECT_TRUE(watched.expired());
}

TEST_F(RenderThreadTest, StartFailsWithoutARenderer) {
  script.create = {kLost};
  const auto started = RenderThread::Start(
      &skeleton, [this] { return Create(); }, &metrics, &Now, [](FinishedPicture) {});
  EXPECT_EQ(started.status().code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace furrow::server
