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

// The thread that owns the EGL context. It takes jobs from the mailbox, renders with two read-backs
// in flight, encodes each picture once per encoding, and passes the results to `deliver`. Without
// viewers it sleeps.
//
// Stills (refined pictures of a subject at rest) use kStillSamples samples per pixel if the
// settings leave the number to the device: with one sample, hair and lashes show specks that are
// noticeable once they stop moving.
//
// A lost context is created again for the next job. While that fails, jobs are dropped and counted,
// twice as many before each new attempt (up to kMaxJobsSkipped), so that a missing GPU does not
// keep a core busy.
class RenderThread : public PictureSource {
 public:
  static constexpr int kMaxJobsSkipped = 255;
  static constexpr int kStillSamples = 4;

  // Receives finished pictures. Called on the render thread, or on the submitting thread if the
  // mailbox is full. Must not block. Every ticket of every job is returned, in a picture with bytes
  // or, after a failure, without.
  using Deliver = std::function<void(FinishedPicture)>;

  // Creates the renderer, at the start and after each loss. Called on the render thread.
  using Factory = std::function<Result<std::unique_ptr<render::Renderer>>()>;

  // Starts the thread and waits for the first renderer. `skeleton`: the character's; outlives this
  // object. Errors: those of `make_renderer`.
  [[nodiscard]] static Result<std::unique_ptr<RenderThread>> Start(
      const wrinkle::Skeleton* skeleton, Factory make_renderer, Metrics* metrics, Deliver deliver);
  ~RenderThread() override;  // drops waiting jobs and joins the thread
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  void Submit(RenderJob job) override;
  bool WithdrawStill(std::uint64_t subscription) override {
    return mailbox_.WithdrawStill(subscription);
  }
  [[nodiscard]] Result<render::Camera> Preset(std::string_view name) const override;
  // The renderer and its device, for people.
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

  // Used by the render thread only.
  std::unique_ptr<render::Renderer> renderer_;  // null: lost
  int jobs_to_skip_ = 0;                        // before the next attempt to create it
  int next_skip_ = 0;                           // doubles until a picture succeeds
  std::deque<RenderJob> in_flight_;             // oldest first, in the order of the read-backs
  wrinkle::CharacterPose drawn_;

  std::thread thread_;
};

}  // namespace furrow::server
