// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <utility>

#include <gtest/gtest.h>

#include "base/status.h"
#include "server/pipeline/render_thread.h"
#include "tests/unit/server/pipeline/scripted_renderer.h"

namespace furrow::server {

inline const Status kLost(StatusCode::kUnavailable, "the context was lost");

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
inline Time TickingClock() {
  static std::atomic<std::int64_t> looks = 0;
  return std::chrono::milliseconds(++looks);
}

class RenderThreadTest : public testing::Test {
 protected:
  void Start(VideoEncoders* video = nullptr) {
    auto started = RenderThread::Start(
        &skeleton, [this] { return Create(); }, &metrics, &TickingClock,
        [this](FinishedPicture picture) { pictures.Put(std::move(picture)); }, video);
    ASSERT_TRUE(started.ok()) << started.status().ToString();
    thread = *std::move(started);
  }
  void StartLater(RenderThread::Factory whole, RenderThread::Factory draft,
                  std::promise<Status>* started) {
    thread = RenderThread::StartLater(
        &skeleton, std::move(whole), &metrics, &TickingClock,
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

}  // namespace furrow::server
