// SPDX-License-Identifier: Apache-2.0
#include "bench/preview/preview_server.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "bench/report/value_or_exit.h"
#include "protocol/messages/hash.h"
#include "server/net/clock.h"
#include "tests/shape_rig.h"

namespace furrow::bench {
namespace {

using server::Time;

constexpr char kSubject[] = "performer";
constexpr Time kTick = server::FromSeconds(0.01);  // as in furrowd

}  // namespace

// Returns its picture at once and records the time.
class PreviewServer::ReadyRenderer : public render::Renderer {
 public:
  explicit ReadyRenderer(PreviewServer* house) : house_(house) {}
  Status Submit(const render::FrameRequest&) override {
    ++in_flight_;
    return {};
  }
  Result<render::Image> Poll(bool) override {
    const auto encoded = static_cast<int>(house_->Count(server::Counter::kPicturesEncoded));
    house_->most_encodes_ = std::max(house_->most_encodes_.load(), encoded - encoded_);
    encoded_ = encoded;
    --in_flight_;
    render::Image image = house_->picture_;
    house_->ready_at_ = server::ReadClock();
    return image;
  }
  int in_flight() const override { return in_flight_; }
  void SetObserver(render::FrameGraphObserver*) override {}
  std::string description() const override { return "a picture"; }
  Result<render::Camera> Preset(std::string_view) const override { return render::Camera(); }

 private:
  PreviewServer* house_;
  int in_flight_ = 0;
  int encoded_ = 0;
};

PreviewServer::PreviewServer(render::Image picture)
    : picture_(std::move(picture)),
      skeleton_(
          wrinkle::Skeleton::Create({{.name = "head", .parent = wrinkle::kNoJoint}}).value()) {
  render_ = ValueOrExit(server::RenderThread::Start(
      &skeleton_,
      [this]() -> Result<std::unique_ptr<render::Renderer>> {
        return std::unique_ptr<render::Renderer>(std::make_unique<ReadyRenderer>(this));
      },
      &metrics_, &server::ReadClock,
      [this](server::FinishedPicture finished) {
        Post([shared = std::make_shared<server::FinishedPicture>(std::move(finished))](
                 server::Hub& hub, Time now) { hub.OnPicture(*shared, now); });
      }));
  server::Hub::Parts parts;
  // One wrinkle weight: a subject with almost no cost.
  parts.rig = std::make_shared<const wrinkle::Rig>(test::ShapeRig("preview", {"brow"}));
  parts.character.skeleton = &skeleton_;
  parts.pictures = render_.get();
  parts.metrics = &metrics_;
  parts.random = [] { return 1; };
  hub_ = std::make_unique<server::Hub>(std::move(parts));
  http_ = ValueOrExit(
      server::HttpServer::Listen({.config = {.port = 0, .max_connections = 1024},
                                  .bind = "127.0.0.1",
                                  .post_to_hub = [this](Task task) { Post(std::move(task)); },
                                  .answer = {},
                                  .metrics = &metrics_}));
  http_->Start();
  loop_ = std::thread([this] { Run(); });
}

PreviewServer::~PreviewServer() {
  Post([this](server::Hub&, Time) { stopping_ = true; });
  loop_.join();
  http_.reset();
  hub_.reset();
}

void PreviewServer::Post(Task task) {
  const std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  changed_.notify_one();
}

void PreviewServer::Run() {
  Offer();
  Time next_tick = server::ReadClock();
  Time next_pose = next_tick;
  std::deque<Task> running;
  while (!stopping_) {
    {
      std::unique_lock lock(mutex_);
      const Time next = std::min(next_tick, next_pose);
      changed_.wait_for(lock, next - server::ReadClock(), [this] { return !tasks_.empty(); });
      running.swap(tasks_);
    }
    for (const Task& task : running) task(*hub_, server::ReadClock());
    running.clear();
    const Time now = server::ReadClock();
    if (now >= next_pose) {
      if (streaming_) SendPose(now);
      next_pose = std::max(next_pose + server::FromSeconds(1.0 / kRate), now);
    }
    if (now < next_tick) continue;
    hub_->Tick(now);
    next_tick = now + kTick;
  }
}

template <class Message>
void PreviewServer::Send(const Message& message, Time now) {
  std::vector<std::uint8_t> bytes;
  encoder_.Encode({.session = 1,
                   .stream = 1,
                   .sequence = poses_,
                   .capture_time_us = server::ToMicroseconds(now)},
                  message, bytes);
  hub_->OnMessage(publisher_, bytes, now);
}

void PreviewServer::Offer() {
  const Time now = server::ReadClock();
  publisher_ = hub_->AddPeer(server::Transport::kWeb, "publisher", &publisher_link_, now);
  protocol::SkeletonOffer offer;
  offer.subject = kSubject;
  offer.blend_shape_names = {"brow"};
  skeleton_hash_ = offer.skeleton_hash = protocol::SkeletonHash(offer);
  Send(offer, now);
}

void PreviewServer::SendPose(Time now) {
  protocol::PoseFrame pose;
  pose.skeleton_hash = skeleton_hash_;
  pose.num_blend_shapes = 1;
  pose.blend_shape_indices = {0};
  pose.blend_shapes = {0.5f + 0.5f * std::sin(0.1f * static_cast<float>(++poses_))};
  Send(pose, now);
}

void PreviewServer::MoveOnce() {
  Post([this](server::Hub&, Time now) { SendPose(now); });
}

void PreviewServer::Stream(bool on) { streaming_ = on; }

}  // namespace furrow::bench
