// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/status.h"
#include "render/graph/frame_graph.h"
#include "render/renderer.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/pipeline/picture_encoder.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/picture_streams.h"
#include "server/pipeline/render_mailbox.h"
#include "server/pipeline/video_encoders.h"
#include "wrinkle/shapes/character_pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::server {

// The thread that owns the EGL context. It takes jobs from the mailbox, renders with two read-backs
// in flight, encodes each picture once per encoding, and passes the results to `deliver`. Without
// viewers it sleeps. Viewers with a video encoder get each picture from their own encoder.
//
// Stills (refined pictures of a subject at rest) use kStillSamples samples per pixel if the
// settings leave the number to the device: with one sample, hair and lashes show specks that are
// noticeable once they stop moving.
//
// With a renderer on the processor, moving pictures that are compressed anyway belong to the stream
// of their viewer (PictureStreams), which draws fewer pixels if the machine is slow.
//
// Lack of memory costs the pictures in flight and the context, not the daemon.
//
// While no picture is wanted, it draws the pictures of Prepare(), so that the programs of the first
// pictures are compiled before somebody waits for them. A picture that nobody wants any more is
// abandoned after the pass that is being drawn.
//
// A character takes seconds to load. A renderer on the processor that is started later
// (StartLater()) may begin with a draft, a coarse character that is there at once, for the viewers
// whose pictures RenderJob::TakesDraft(). All others wait for the whole character.
//
// A lost context is created again for the next job. While that fails, jobs are dropped and counted,
// twice as many before each new attempt (up to kMaxJobsSkipped), so that a missing GPU does not
// keep a core busy.
class RenderThread : public PictureSource {
 public:
  static constexpr int kMaxJobsSkipped = 255;
  // Weights matter more than pictures where both need the same core.
  static constexpr int kNiceness = 5;

  // Receives finished pictures. Called on the render thread, and on the threads of Submit() and
  // Watch() for jobs that are refused. Must not block. Every ticket of every job is returned, in a
  // picture with bytes or, after a failure, without.
  using OnPicture = PictureEncoder::Deliver;

  using Clock = Time (*)();

  // Creates the renderer, at the start and after each loss. Called on the render thread.
  using Factory = std::function<Result<std::unique_ptr<render::Renderer>>()>;

  // Called once on the render thread, when the renderer is there or has failed.
  using OnStarted = std::function<void(const Status&)>;
  using Presets = std::vector<std::pair<std::string, render::Camera>>;

  struct Later {
    Presets presets;  // the cameras of the character, so that viewers can ask before it is loaded
    // Creates the renderer of a draft. Called on the render thread; `make_renderer` runs at the
    // same time on another thread. Empty: there is no draft.
    Factory draft;
    OnStarted on_started;
  };

  // Starts the thread and waits for the first renderer. `skeleton`: the character's. `clock`: for
  // the histograms of the stages; called on any thread. `video`: null means that all pictures are
  // files. `skeleton` and `video` outlive this object. Errors: those of `make_renderer`.
  [[nodiscard]] static Result<std::unique_ptr<RenderThread>> Start(
      const wrinkle::Skeleton* skeleton, Factory make_renderer, Metrics* metrics, Clock clock,
      OnPicture deliver, VideoEncoders* video = nullptr);
  // The same, but does not wait: jobs wait for the renderer, and are refused if it fails.
  [[nodiscard]] static std::unique_ptr<RenderThread> StartLater(const wrinkle::Skeleton* skeleton,
                                                                Factory make_renderer,
                                                                Metrics* metrics, Clock clock,
                                                                OnPicture deliver,
                                                                VideoEncoders* video, Later later);
  ~RenderThread() override;  // drops waiting jobs and joins the thread
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  // At most this much work per second; see RenderMailbox::SetBudget().
  void SetBudget(const WorkBudget::Limits& limits) { mailbox_.SetBudget(limits, clock_); }
  // Draws these jobs in this order while nobody wants a picture, and drops the results.
  void Prepare(std::vector<RenderJob> jobs);
  void Submit(RenderJob job) override;
  bool WithdrawStill(std::uint64_t subscription) override {
    return mailbox_.WithdrawStill(subscription);
  }
  void Withdraw(std::uint64_t subscription) override;
  [[nodiscard]] bool OpenVideo(std::uint64_t subscription, const std::string& host,
                               const render::VideoFormat& format) override {
    return video_ != nullptr && video_->Open(subscription, host, format);
  }
  void CloseVideo(std::uint64_t subscription) override {
    if (video_ != nullptr) video_->Close(subscription);
  }
  [[nodiscard]] std::optional<Drawing> drawing() const override { return progress_.drawing(); }
  [[nodiscard]] bool is_software() const override { return started_ && is_software_; }
  [[nodiscard]] bool is_stuck() const override { return stuck_ || failed_; }
  [[nodiscard]] bool is_starting() const override { return !failed_ && (!started_ || drafts_); }
  [[nodiscard]] std::string fault() const override;
  // Draws nothing more; the picture that is being drawn is completed. Does not wait for it.
  void Stop() { mailbox_.Close(); }
  // True once the thread draws nothing any more, and its renderer and its factory are gone.
  [[nodiscard]] bool ended() const { return ended_; }
  // Call it about once per second, always on the same thread. A renderer that does not come back
  // for kStuckAfter, because the driver or the GPU hangs, is stuck: waiting and new jobs fail until
  // it comes back. OpenGL calls cannot be interrupted, so the thread itself waits.
  void Watch(Time now);
  // Longer than a fence is waited for (render/gl/read_back.cpp) takes a driver that hangs.
  static constexpr Time kStuckAfter = std::chrono::seconds(30);
  [[nodiscard]] Result<render::Camera> Preset(std::string_view name) const override;
  [[nodiscard]] std::string description() const override {
    return started_ ? description_ : std::string("starting");
  }

 private:
  // Counts the passes of the frame, for drawing(), and ends it if nobody wants it.
  class Progress : public render::FrameGraphObserver {
   public:
    // `steps`: steps_, which each pass moves on: a long frame is not a renderer that hangs.
    Progress(const RenderMailbox* mailbox, std::atomic<std::uint64_t>* steps)
        : mailbox_(mailbox), steps_(steps) {}
    void Begin(const RenderJob* job);
    void End();
    // True if the last frame was ended, because nobody wanted it.
    [[nodiscard]] bool abandoned() const { return abandoned_; }
    [[nodiscard]] std::optional<Drawing> drawing() const;

    void BeginFrame(int passes) override { passes_ = passes; }
    [[nodiscard]] bool Continues() override;
    void BeforePass(std::string_view) override {}
    void AfterPass(std::string_view, const std::vector<Written>&) override {
      ++done_;
      *steps_ += 2;  // it stays odd
    }

   private:
    const RenderMailbox* const mailbox_;
    std::atomic<std::uint64_t>* const steps_;
    const RenderJob* job_ = nullptr;
    bool abandoned_ = false;
    std::atomic<int> done_ = 0;
    std::atomic<int> passes_ = 0;  // 0: no frame is being drawn
  };

  RenderThread(const wrinkle::Skeleton* skeleton, Factory make_renderer, Metrics* metrics,
               Clock clock, OnPicture deliver, VideoEncoders* video);

  Status CreateRenderer();
  void Use(std::unique_ptr<render::Renderer> renderer);
  bool Revive();
  void BackOff();
  void Run(const Later& later);
  [[nodiscard]] Status StartRenderer(const Later& later);
  void StartDraft(const Factory& make);
  void DrawUntilClosed();
  void DrawAndCollect();
  void Draw(RenderJob job);
  Status Render(RenderJob* job);
  [[nodiscard]] std::optional<RenderJob> TakeJob();
  void Collect(bool wait);
  void Finish(const render::Image& image, RenderJob job);
  void Abandon(RenderJob job);
  void Fail(RenderJob job);
  void Refuse(RenderJob job);
  void Deliver(FinishedPicture picture);
  void Rebuild(const Status& reason);

  Factory make_renderer_;
  Metrics* const metrics_;
  const Clock clock_;
  const OnPicture deliver_;
  VideoEncoders* const video_;  // may be null
  RenderMailbox mailbox_;
  std::atomic<bool> ended_ = false;
  std::atomic<bool> failed_ = false;   // the first renderer
  std::atomic<bool> drafts_ = false;   // renderer_ draws a draft, or is null until the whole one
  std::atomic<bool> started_ = false;  // the next three are written before, and stay
  Presets presets_;                    // with Later, from the beginning
  std::string description_;
  bool is_software_ = false;
  Progress progress_;

  std::atomic<std::uint64_t> steps_ = 0;  // odd while the renderer works
  std::atomic<bool> stuck_ = false;

  // Used by Watch() only.
  std::uint64_t watched_step_ = 0;
  Time watched_since_{0};

  // Used by the render thread only.
  std::unique_ptr<render::Renderer> renderer_;  // null: lost
  int jobs_to_skip_ = 0;                        // before the next attempt to create it
  int next_skip_ = 0;                           // doubles until a picture succeeds
  std::deque<RenderJob> in_flight_;             // oldest first, in the order of the read-backs
  PictureStreams streams_;
  Time idle_{0};  // without anything to draw, altogether
  wrinkle::CharacterPose drawn_;
  PictureEncoder encoder_;

  std::thread thread_;
};

}  // namespace furrow::server
