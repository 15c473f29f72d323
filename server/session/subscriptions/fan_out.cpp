// SPDX-License-Identifier: Apache-2.0
// The part of Subscribers that runs at every pose: who is due, and what they get.
#include <algorithm>
#include <utility>

#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {
namespace {

// How many frames of a subscription may wait for a slow peer.
constexpr std::size_t kFramesKept = 4;

std::size_t KeptOf(const Subscription& subscription) {
  return subscription.every ? kKeepAll : kFramesKept;
}

PicturesWish* FlowOf(Subscription& subscription) {
  auto* wish = std::get_if<PicturesWish>(&subscription.wish);
  return wish != nullptr && wish->flow ? wish : nullptr;
}

}  // namespace

void Subscribers::Publish(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us,
                          Time now, Desk* desk) {
  const auto watching = by_subject_.find(subject.id);
  if (watching == by_subject_.end()) return;
  desk->encoded_wish.reset();
  bool has_looked = false;
  for (Subscription* subscription : watching->second) {
    if (age_us > 0 && std::holds_alternative<PosesWish>(subscription->wish)) continue;
    if (PicturesWish* wish = FlowOf(*subscription); wish != nullptr) {
      if (!std::exchange(has_looked, true)) {
        subject.rest.Update(subject.pipeline->pose(), subject.pipeline->wrinkle_weights(), now);
      }
      wish->flow->CountDue(now);
    }
    if (HoldBack(*subscription)) {
      subscription->owed = true;
      continue;
    }
    subscription->owed = !subscription->gate.Pass(now);
    if (subscription->owed) {
      metrics_->Add(Counter::kFramesSkippedRate);
    } else {
      Deliver(*subscription, pose, age_us, now, desk);
    }
  }
  SubmitJobs(&desk->jobs);
}

void Subscribers::PublishOwed(Time now) {
  for (auto& [uid, subscription] : subscriptions_) {
    TellDropped(*subscription, now);
    if (subscription->subject == nullptr) continue;
    if (const PicturesWish* wish = FlowOf(*subscription); wish != nullptr) {
      // At rest each viewer gets one refined picture, though no pose calls for it.
      subscription->owed |= !wish->flow->HasStill(ShownSince(*subscription, *wish)) &&
                            Rests(*subscription, *wish, now);
    }
    if (subscription->owed) PublishOwed(*subscription, now);
  }
}

// For a peer that takes nothing, nothing is encoded or kept: what waits is dropped once, and when
// it takes something again the newest pose comes first. Pictures have a flow control of their own.
bool Subscribers::HoldBack(Subscription& subscription) {
  const bool can_wait =
      !subscription.every && !std::holds_alternative<PicturesWish>(subscription.wish);
  if (!subscription.peer->stuck || !can_wait) return subscription.held_back = false;
  if (!subscription.held_back) subscription.peer->link->DropFrames(subscription.uid);
  ++subscription.dropped;
  metrics_->Add(std::holds_alternative<PosesWish>(subscription.wish)
                    ? Counter::kPosesDroppedSlow
                    : Counter::kWeightsDroppedSlow);
  return subscription.held_back = true;
}

void Subscribers::PublishOwed(Subscription& subscription, Time now) {
  if (subscription.held_back && subscription.peer->stuck) return;
  subscription.held_back = false;
  PicturesWish* viewer = FlowOf(subscription);
  if (viewer != nullptr && !viewer->flow->MayAsk(now)) return;
  if (!subscription.gate.Pass(now)) return;
  subscription.owed = false;
  const Subject& subject = *subscription.subject;
  if (!subject.pipeline->has_pose()) return;  // offered anew meanwhile
  desk_->encoded_wish.reset();
  const std::int64_t age_us = subject.lost ? ToMicroseconds(now - subject.last_pose) : 0;
  Deliver(subscription, {}, age_us, now, desk_);
  SubmitJobs(&desk_->jobs);
}

void Subscribers::Deliver(Subscription& subscription, std::span<const std::uint8_t> pose,
                          std::int64_t age_us, Time now, Desk* desk) {
  if (const auto* wish = std::get_if<WeightsWish>(&subscription.wish)) {
    SendWeights(subscription, *wish, age_us, desk);
  } else if (std::holds_alternative<PosesWish>(subscription.wish)) {
    SendPose(subscription, pose, desk);
  } else {
    AddToJobs(subscription, std::get<PicturesWish>(subscription.wish), age_us, now, &desk->jobs);
  }
}

void Subscribers::SendWeights(Subscription& subscription, const WeightsWish& wish,
                              std::int64_t age_us, Desk* desk) {
  const SubjectPipeline& pipeline = *subscription.subject->pipeline;
  EncodeWeights(pipeline, wish, age_us, desk);
  subscription.dropped += desk->postman.Forward(
      *subscription.peer, subscription.uid,
      {.stream = subscription.id,
       .sequence = pipeline.sequence(),
       .capture_time_us = pipeline.capture_time_us()},
      std::span(desk->encoded).subspan(protocol::kEnvelopeBytes), Counter::kWeightsSent,
      Counter::kWeightsDroppedSlow, KeptOf(subscription));
}

// Once for all subscriptions of a subject that ask for the same.
void Subscribers::EncodeWeights(const SubjectPipeline& pipeline, const WeightsWish& wish,
                                std::int64_t age_us, Desk* desk) {
  const Desk::EncodedWish is_due{wish.names_hash, wish.format, wish.source};
  if (desk->encoded_wish == is_due) return;
  desk->encoded_wish = is_due;
  const std::span<const float> values = wish.source == protocol::WeightSource::kDriverValues
                                            ? pipeline.driver_values()
                                            : pipeline.wrinkle_weights();
  protocol::WeightFrame& weights = desk->weights;
  weights.names_hash = wish.names_hash;
  weights.age_us = age_us;
  weights.format = wish.format;
  weights.values.resize(wish.indices.size());
  std::ranges::transform(wish.indices, weights.values.begin(),
                         [values](std::uint32_t index) { return values[index]; });
  desk->postman.Encode(weights, desk->encoded);
}

}  // namespace furrow::server
