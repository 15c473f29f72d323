// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/fan_out.h"

#include <utility>
#include <variant>

#include "server/session/subscriptions/weight_sender.h"

namespace furrow::server {
namespace {

// A subscription to every frame must not be held back: its frames queue (kKeepAll). Pictures have
// their own flow control.
bool CanWait(const Subscription& subscription) {
  return !subscription.every && !std::holds_alternative<PictureRequest>(subscription.request);
}

}  // namespace

void FanOut::Publish(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us,
                     Time now, PublishContext* context) {
  // Subscriptions change only under the exclusive lock, so the span is stable here. Their delivery
  // state (gate, owed, flow) belongs to the subject's shard: a subscription has one subject, and a
  // subject is published by one shard at a time.
  const std::span<Subscription* const> subscriptions = subject.subscriptions;
  if (subscriptions.empty()) return;
  // The encoding of the subject before this one must not be reused.
  context->encoded_key.reset();
  bool has_checked_rest = false;
  for (Subscription* subscription : subscriptions) {
    // Without a new pose there is nothing to relay.
    if (age_us > 0 && std::holds_alternative<PoseRequest>(subscription->request)) continue;
    if (PictureRequest* viewer = PictureViews::FlowControlled(*subscription); viewer != nullptr) {
      // Comparing whole poses is not free, so it happens once and only if a viewer needs it.
      if (!std::exchange(has_checked_rest, true)) {
        subject.rest.Update(subject.pipeline->pose(), subject.pipeline->wrinkle_weights(), now);
      }
      viewer->flow->CountDue(now);
    }
    if (HoldBack(*subscription)) {
      subscription->owed = true;
      continue;
    }
    subscription->owed = !subscription->gate.Pass(now);
    if (subscription->owed) {
      metrics_->Add(Counter::kFramesSkippedRate);
    } else {
      Deliver(*subscription, pose, age_us, now, context);
    }
  }
  // After the loop, so that viewers with equal views share a job.
  pictures_->Submit(&context->jobs);
}

void FanOut::SendOwed(Time now) {
  table_->ForEach([&](Subscription& subscription) {
    poses_->ReportDropped(subscription, now);
    if (subscription.subject == nullptr) return;
    // A viewer gets one refined picture of a subject at rest, although no pose asks for it.
    subscription.owed |= PictureViews::NeedsStill(subscription, now);
    if (subscription.owed) SendOwed(subscription, now);
  });
}

void FanOut::SendOwed(Subscription& subscription, Time now) {
  // Another node may serve the subject. The frame stays owed, for a lease that comes back.
  if (now >= subscription.subject->served_until) return;
  if (subscription.peer->stuck && CanWait(subscription)) return;
  subscription.held_back = false;
  // Ask the flow control before the gate: Pass() spends the time slot even if nothing is sent.
  const PictureRequest* viewer = PictureViews::FlowControlled(subscription);
  if (viewer != nullptr && !viewer->flow->CanRequest(now)) return;
  if (!subscription.gate.Pass(now)) return;
  subscription.owed = false;
  const Subject& subject = *subscription.subject;
  if (!subject.pipeline->has_pose()) return;  // a new skeleton was offered in the meantime
  exclusive_context_->encoded_key.reset();
  // A subject that is lost shows decayed weights, not those of its last pose. Age 0 means a new
  // pose.
  const std::int64_t age_us = subject.lost ? ToMicroseconds(now - subject.last_pose) : 0;
  Deliver(subscription, {}, age_us, now, exclusive_context_);
  pictures_->Submit(&exclusive_context_->jobs);
}

// A stuck peer costs nothing: its queued frames are dropped once, nothing is encoded for it, and
// the newest pose comes first when it reads again.
bool FanOut::HoldBack(Subscription& subscription) {
  if (!subscription.peer->stuck || !CanWait(subscription)) return subscription.held_back = false;
  if (!subscription.held_back) subscription.peer->link->DropFrames(subscription.uid);
  ++subscription.dropped;
  metrics_->Add(std::holds_alternative<PoseRequest>(subscription.request)
                    ? Counter::kPosesDroppedSlow
                    : Counter::kWeightsDroppedSlow);
  return subscription.held_back = true;
}

void FanOut::Deliver(Subscription& subscription, std::span<const std::uint8_t> pose,
                     std::int64_t age_us, Time now, PublishContext* context) {
  if (const auto* weights = std::get_if<WeightsRequest>(&subscription.request)) {
    SendWeights(subscription, *weights, age_us, context);
  } else if (std::holds_alternative<PoseRequest>(subscription.request)) {
    PoseRelay::SendPose(subscription, pose, context);
  } else {
    pictures_->AddJob(subscription, std::get<PictureRequest>(subscription.request), age_us, now,
                      &context->jobs);
  }
}

}  // namespace furrow::server
