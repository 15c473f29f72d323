// SPDX-License-Identifier: Apache-2.0
// The part of Subscribers that runs at every pose: who is due, and what they get.
#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "protocol/limits.h"
#include "server/session/subscribers.h"

namespace furrow::server {
namespace {

// How many frames of a subscription may wait for a slow peer.
constexpr std::size_t kFramesKept = 4;
constexpr std::size_t kPicturesKept = 1;
// What a message of kMaxReplyBytes has room for beside its envelope and table.
constexpr std::size_t kMaxPictureBytes = protocol::kMaxReplyBytes - 1024;

std::size_t KeptOf(const Subscription& subscription) {
  return subscription.every ? kKeepAll : kFramesKept;
}

}  // namespace

void Subscribers::Publish(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us,
                          Time now) {
  const auto watching = by_subject_.find(subject.id);
  if (watching == by_subject_.end()) return;
  for (Subscription* subscription : watching->second) {
    if (age_us > 0 && std::holds_alternative<PosesWish>(subscription->wish)) continue;
    subscription->owed = !subscription->gate.Pass(now);
    if (subscription->owed) {
      metrics_->Add(Counter::kFramesSkippedRate);
    } else {
      Deliver(*subscription, pose, age_us, &jobs_);
    }
  }
  SubmitJobs(&jobs_);
}

void Subscribers::PublishOwed(Time now) {
  for (auto& [uid, subscription] : subscriptions_) {
    TellDropped(*subscription, now);
    if (!subscription->owed || !subscription->gate.Pass(now)) continue;
    subscription->owed = false;
    const Subject& subject = *subscription->subject;
    if (!subject.pipeline->has_pose()) continue;  // offered anew meanwhile
    Deliver(*subscription, {}, subject.lost ? ToMicroseconds(now - subject.last_pose) : 0, &jobs_);
    SubmitJobs(&jobs_);
  }
}

void Subscribers::Deliver(Subscription& subscription, std::span<const std::uint8_t> pose,
                          std::int64_t age_us, Jobs* jobs) {
  if (const auto* wish = std::get_if<WeightsWish>(&subscription.wish)) {
    SendWeights(subscription, *wish, age_us);
  } else if (std::holds_alternative<PosesWish>(subscription.wish)) {
    SendPose(subscription, pose);
  } else {
    AddToJobs(subscription, std::get<PicturesWish>(subscription.wish), age_us, jobs);
  }
}

void Subscribers::SendWeights(Subscription& subscription, const WeightsWish& wish,
                              std::int64_t age_us) {
  const SubjectPipeline& pipeline = *subscription.subject->pipeline;
  const std::span<const float> values = wish.source == protocol::WeightSource::kDriverValues
                                            ? pipeline.driver_values()
                                            : pipeline.wrinkle_weights();
  frame_.names_hash = wish.names_hash;
  frame_.age_us = age_us;
  frame_.format = wish.format;
  frame_.values.resize(wish.indices.size());
  std::ranges::transform(wish.indices, frame_.values.begin(),
                         [values](std::uint32_t index) { return values[index]; });
  subscription.dropped += postman_->Frame(*subscription.peer, subscription.uid,
                                          {.stream = subscription.id,
                                           .sequence = pipeline.sequence(),
                                           .capture_time_us = pipeline.capture_time_us()},
                                          frame_, Counter::kWeightsSent,
                                          Counter::kWeightsDroppedSlow, KeptOf(subscription));
}

// Subscriptions of one subject that show the same share one job, and with it one picture.
void Subscribers::AddToJobs(const Subscription& subscription, const PicturesWish& wish,
                            std::int64_t age_us, Jobs* jobs) {
  auto job = std::ranges::find(*jobs, wish.spec, &RenderJob::spec);
  if (job == jobs->end()) {
    std::shared_ptr<const Snapshot> snapshot =
        jobs->empty() ? subscription.subject->pipeline->TakeSnapshot(age_us)
                      : jobs->front().snapshot;
    jobs->push_back({subscription.subject->id, wish.spec, std::move(snapshot), {}});
    job = jobs->end() - 1;
  }
  job->tickets.push_back({subscription.uid, wish.encoding});
}

void Subscribers::SubmitJobs(Jobs* jobs) {
  for (RenderJob& job : *jobs) pictures_->Submit(std::move(job));
  jobs->clear();
}

void Subscribers::OnPicture(const FinishedPicture& picture) {
  image_.width = static_cast<std::uint16_t>(picture.width);
  image_.height = static_cast<std::uint16_t>(picture.height);
  image_.format = picture.encoding.format == render::ImageFormat::kPng
                      ? protocol::ImageFormat::kPng
                      : protocol::ImageFormat::kJpeg;
  image_.age_us = picture.age_us;
  image_.bytes = picture.bytes;
  if (picture.bytes.size() > kMaxPictureBytes) {
    metrics_->Add(Counter::kPicturesFailed, picture.tickets.size());
    if (!std::exchange(has_named_large_picture_, true)) {
      spdlog::warn("a picture of {} x {} has {} bytes, more than the wire carries: ask for JPEG",
                   picture.width, picture.height, picture.bytes.size());
    }
    return;
  }
  for (const PictureTicket& ticket : picture.tickets) {
    const auto found = subscriptions_.find(ticket.subscription);
    if (found == subscriptions_.end()) continue;
    const Subscription& subscription = *found->second;
    postman_->Frame(*subscription.peer, subscription.uid,
                    {.stream = subscription.id,
                     .sequence = picture.sequence,
                     .capture_time_us = picture.capture_time_us},
                    image_, Counter::kPicturesSent, Counter::kPicturesDroppedSlow, kPicturesKept);
  }
}

}  // namespace furrow::server
