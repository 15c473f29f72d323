// SPDX-License-Identifier: Apache-2.0
// The part of Subscribers that concerns pictures: what a viewer asks for, when it is drawn, and
// what it gets.
#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/status.h"
#include "protocol/messages/limits.h"
#include "render/request/request_check.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;

// Of a subscription without flow control, how many wait for a slow peer.
constexpr std::size_t kPicturesKept = 1;
// What a message of kMaxReplyBytes has room for beside its envelope and table.
constexpr std::size_t kMaxPictureBytes = protocol::kMaxReplyBytes - 1024;

constexpr Time kRestsAfter = FromSeconds(0.1);
constexpr int kTierQualities[ViewerFlow::kNumTiers] = {85, 65, 45};

Result<render::Camera> CameraOf(const protocol::SubscribePictures& request,
                                const PictureSource& pictures) {
  if (!request.has_camera) {
    return pictures.Preset(request.camera_preset.empty() ? "face" : request.camera_preset);
  }
  render::Camera camera;
  if (request.camera_follows) {
    const Result<render::Camera> preset = pictures.Preset("face");
    FURROW_RETURN_IF_ERROR(preset);
    camera = *preset;
  }
  const protocol::Camera& given = request.camera;
  camera.position = {given.eye.x, given.eye.y, given.eye.z};
  camera.target = {given.target.x, given.target.y, given.target.z};
  camera.fov_y_degrees = given.vertical_fov_degrees;
  render::FrameRequest drawn;
  drawn.camera = camera;
  drawn.camera.follow_joint = -1;  // the character's, which is not looked at here
  FURROW_RETURN_IF_ERROR(render::CheckRequest(drawn, /*num_joints=*/0));
  return camera;
}

}  // namespace

Result<PicturesWish> Subscribers::MakeWish(const protocol::SubscribePictures& request) {
  PicturesWish wish;
  const Result<render::View> view = render::ParseView(request.view);
  FURROW_RETURN_IF_ERROR(view);
  Result<SharedSettings> settings = settings_.Get(request.settings);
  FURROW_RETURN_IF_ERROR(settings);
  const Result<render::Camera> camera = CameraOf(request, *pictures_);
  FURROW_RETURN_IF_ERROR(camera);
  wish.spec = {.view = *view,
               .camera = *camera,
               .width = request.width,
               .height = request.height,
               .settings = *std::move(settings)};
  wish.overrides = request.settings;
  const bool png = request.format == protocol::ImageFormat::kPng;
  wish.encoding.format = png ? render::ImageFormat::kPng : render::ImageFormat::kJpeg;
  wish.encoding.quality = png ? 0 : request.quality;
  return wish;
}

void Subscribers::Update(Peer& peer, const protocol::Header& header,
                         const protocol::SubscribePictures& request, Time now) {
  Subscription* subscription = Find(peer, header.stream);
  auto* wish = subscription == nullptr ? nullptr : std::get_if<PicturesWish>(&subscription->wish);
  if (wish == nullptr) {
    return postman_->Error(peer, header, ErrorCode::kBadPicture,
                           "there is no such subscription of pictures");
  }
  Result<PicturesWish> changed = MakeWish(request);
  if (!changed.ok()) {
    return postman_->Error(peer, header, ErrorCode::kBadPicture, changed.status().ToString());
  }
  changed->flow = std::move(wish->flow);
  changed->view_request = header.sequence;
  *wish = *std::move(changed);
  subscription->gate.SetRate(request.max_rate_hz);
  ShowChanged(*subscription, *wish, now);
}

void Subscribers::SetOwnSettings(const render::Settings& settings, Time now) {
  settings_.SetOwn(settings);
  for (auto& [uid, subscription] : subscriptions_) {
    auto* wish = std::get_if<PicturesWish>(&subscription->wish);
    if (wish == nullptr) continue;
    // What is valid over one set of settings is over every other.
    if (Result<SharedSettings> own = settings_.Get(wish->overrides); own.ok()) {
      wish->spec.settings = *std::move(own);
      ShowChanged(*subscription, *wish, now);
    }
  }
}

void Subscribers::Acknowledge(Peer& peer, const protocol::Header& header, std::uint32_t number,
                              Time now) {
  Subscription* subscription = Find(peer, header.stream);
  auto* wish = subscription == nullptr ? nullptr : std::get_if<PicturesWish>(&subscription->wish);
  if (wish == nullptr || !wish->flow) return;  // ended meanwhile
  if (!wish->flow->Acknowledge(number)) {
    return postman_->Error(peer, header, ErrorCode::kMalformed,
                           "picture " + std::to_string(number) + " was never sent");
  }
  if (subscription->owed) Show(*subscription, now);
}

// The newest pose in the view as it is now, as soon as may be.
void Subscribers::Show(Subscription& subscription, Time now) {
  subscription.owed = subscription.subject != nullptr;
  if (subscription.owed && subscription.subject->pipeline->has_pose()) {
    PublishOwed(subscription, now);
  }
}

// The view is another from now on: a still of the former one is not waited for.
void Subscribers::ShowChanged(Subscription& subscription, PicturesWish& wish, Time now) {
  wish.changed = now;
  if (wish.flow && wish.flow->asking() && pictures_->WithdrawStill(subscription.uid)) {
    wish.flow->Withdraw();
  }
  Show(subscription, now);
}

Time Subscribers::ShownSince(const Subscription& subscription, const PicturesWish& wish) {
  return std::max(subscription.subject->rest.moved_at(), wish.changed);
}

bool Subscribers::Rests(const Subscription& subscription, const PicturesWish& wish, Time now) {
  return now - ShownSince(subscription, wish) >= kRestsAfter;
}

// A pose that a viewer with flow control is due, or one that it is still owed.
void Subscribers::AskForPicture(Subscription& subscription, PicturesWish& wish, std::int64_t age_us,
                                Time now, Jobs* jobs) {
  ViewerFlow& flow = *wish.flow;
  const bool rests = Rests(subscription, wish, now);
  subscription.owed = false;
  if (rests && flow.HasStill(ShownSince(subscription, wish)))
    return;  // nothing to be seen that was not shown
  if (!flow.MayAsk(now)) {
    subscription.owed = true;
    // One that waits to be drawn is drawn as of now.
    if (flow.asking()) JobOf(subscription, wish.spec, age_us, jobs);
    return;
  }
  flow.Ask(rests, now);
  PictureTicket ticket{.subscription = subscription.uid,
                       .encoding = wish.encoding,
                       .view_request = wish.view_request,
                       .tier = static_cast<std::uint8_t>(flow.tier()),
                       .still = rests};
  if (wish.encoding.format == render::ImageFormat::kJpeg) {
    ticket.encoding.quality = kTierQualities[flow.tier()];
  }
  JobOf(subscription, wish.spec, age_us, jobs).tickets.push_back(ticket);
}

void Subscribers::AddToJobs(Subscription& subscription, PicturesWish& wish, std::int64_t age_us,
                            Time now, Jobs* jobs) {
  if (wish.flow) return AskForPicture(subscription, wish, age_us, now, jobs);
  JobOf(subscription, wish.spec, age_us, jobs)
      .tickets.push_back({.subscription = subscription.uid,
                          .encoding = wish.encoding,
                          .view_request = wish.view_request});
}

// Subscriptions of one subject that show the same share one job, and with it one picture.
RenderJob& Subscribers::JobOf(const Subscription& subscription, const PictureSpec& spec,
                              std::int64_t age_us, Jobs* jobs) {
  const auto job = std::ranges::find(*jobs, spec, &RenderJob::spec);
  if (job != jobs->end()) return *job;
  const Subject& subject = *subscription.subject;
  std::shared_ptr<const Snapshot> snapshot =
      jobs->empty() ? subject.pipeline->TakeSnapshot(age_us, ToMicroseconds(subject.last_pose))
                    : jobs->front().snapshot;
  jobs->push_back({subject.id, spec, std::move(snapshot), {}, subject.rest.moved_at()});
  return jobs->back();
}

void Subscribers::SubmitJobs(Jobs* jobs) {
  for (RenderJob& job : *jobs) pictures_->Submit(std::move(job));
  jobs->clear();
}

void Subscribers::OnPicture(const FinishedPicture& picture) {
  const bool too_large = picture.bytes.size() > kMaxPictureBytes;
  if (too_large) {
    metrics_->Add(Counter::kPicturesFailed, picture.tickets.size());
    if (!std::exchange(has_named_large_picture_, true)) {
      spdlog::warn("a picture of {} x {} has {} bytes, more than the wire carries: ask for JPEG",
                   picture.width, picture.height, picture.bytes.size());
    }
  }
  const bool failed = too_large || picture.bytes.empty();
  if (!failed) FillImage(picture);
  for (const PictureTicket& ticket : picture.tickets) {
    const auto found = subscriptions_.find(ticket.subscription);
    if (found == subscriptions_.end()) continue;
    if (failed) {
      PictureFailed(*found->second);
    } else {
      SendPicture(*found->second, picture, ticket);
    }
  }
}

void Subscribers::PictureFailed(Subscription& subscription) {
  auto* wish = std::get_if<PicturesWish>(&subscription.wish);
  if (wish == nullptr || !wish->flow) return;
  wish->flow->Fail();
  subscription.owed = subscription.subject != nullptr;
}

void Subscribers::FillImage(const FinishedPicture& picture) {
  image_.width = static_cast<std::uint16_t>(picture.width);
  image_.height = static_cast<std::uint16_t>(picture.height);
  image_.format = picture.encoding.format == render::ImageFormat::kPng
                      ? protocol::ImageFormat::kPng
                      : protocol::ImageFormat::kJpeg;
  image_.age_us = picture.age_us;
  image_.received_us = picture.received_us;
  image_.bytes = picture.bytes;
}

void Subscribers::SendPicture(Subscription& subscription, const FinishedPicture& picture,
                              const PictureTicket& ticket) {
  auto& wish = std::get<PicturesWish>(subscription.wish);
  image_.view_request = ticket.view_request;
  image_.tier = ticket.still ? 0 : ticket.tier;
  image_.still = ticket.still;
  image_.number = wish.flow ? wish.flow->Send() : 0;
  image_.dropped = wish.flow ? wish.flow->dropped() : 0;
  postman_->Frame(*subscription.peer, subscription.uid,
                  {.stream = subscription.id,
                   .sequence = picture.sequence,
                   .capture_time_us = picture.capture_time_us},
                  image_, Counter::kPicturesSent, Counter::kPicturesDroppedSlow,
                  wish.flow ? ViewerFlow::kMaxUnderWay : kPicturesKept);
}

}  // namespace furrow::server
