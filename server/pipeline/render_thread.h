// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/status.h"
#include "render/renderer.h"
#include "server/core/metrics.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/render_mailbox.h"
#include "wrinkle/shapes/character_pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::server {

// The thread that owns the EGL context: takes jobs from the mailbox, draws with two read-backs in
// flight, encodes once an encoding, hands pictures to `deliver`. Stills are drawn with
// kStillSamples a pixel where the settings leave it to the device: hair and lashes that speckle at
// one sample, and may while they move, do not where the eye has time to look.
//
// It sleeps while nobody watches. A context that is lost is rebuilt for the next job; while that
// fails, jobs are dropped and counted, and twice as many each time before it is tried again (to
// kMaxJobsSkipped), so that a GPU that is gone costs no core.
class RenderThread : public PictureSource {
 public:
  static constexpr int kMaxJobsSkipped = 255;
  static constexpr int kStillSamples = 4;

  // Called on the render thread, for a job that finds no room on the one that submits; must not
  // block. Every ticket of every job comes back, with bytes or without.
  using Deliver = std::function<void(FinishedPicture)>;

  // Makes the renderer of the character, at the start and whenever one was lost; called on the
  // render thread. The daemon's is render::Renderer::Create.
  using Factory = std::function<Result<std::unique_ptr<render::Renderer>>()>;

  // `skeleton` is the character's and outlives the thread. Returns when the context stands. Errors:
  // those of `make_renderer`.
  [[nodiscard]] static Result<std::unique_ptr<RenderThread>> Start(
      const wrinkle::Skeleton* skeleton, Factory make_renderer, Metrics* metrics, Deliver deliver);
  ~RenderThread() override;  // closes the mailbox and joins
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  void Submit(RenderJob job) override;
  bool WithdrawStill(std::uint64_t subscription) override {
    return mailbox_.WithdrawStill(subscription);
  }
  [[nodiscard]] Result<render::Camera> Preset(std::string_view name) const override;
  [[nodiscard]] const std::string& description() const { return description_; }

 private:
  RenderThread(const wrinkle::Skeleton* skeleton, Factory make_renderer, Metrics* metrics,
               Deliver deliver);

  Status CreateRenderer();
  bool Revive();
  void BackOff();
  void Run(std::promise<Status> started);
  void Draw(RenderJob job);
  void Collect(bool wait);
  void Finish(const render::Image& image, const RenderJob& job);
  void Fail(RenderJob job);
  void Rebuild(const Status& reason);

  const Factory make_renderer_;
  Metrics* const metrics_;
  const Deliver deliver_;
  RenderMailbox mailbox_;
  std::vector<std::pair<std::string, render::Camera>> presets_;  // written before Start() returns
  std::string description_;

  // The render thread's own.
  std::unique_ptr<render::Renderer> renderer_;  // null: lost
  int jobs_to_skip_ = 0;                        // before it is made again
  int next_skip_ = 0;                           // grows until a picture comes out
  std::deque<RenderJob> in_flight_;             // as the renderer's read-backs, oldest first
  wrinkle::CharacterPose drawn_;

  std::thread thread_;
};

}  // namespace furrow::server
