// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/pose_relay.h"

#include <chrono>
#include <cstddef>

#include "protocol/messages/limits.h"
#include "server/pipeline/wire_adapter.h"

namespace furrow::server {
namespace {

// Poses that may wait for a slow peer, unless it asked for every one.
constexpr std::size_t kMaxQueuedPoses = 4;
constexpr Time kReportInterval = std::chrono::seconds(1);

}  // namespace

void PoseRelay::FillOffer(const Subject& subject) {
  offer_ = *subject.offer;
  offer_.subject = subject.name;  // the shared offer has no name
}

// The offer is encoded to measure it; names and alignment make its size hard to predict.
bool PoseRelay::Fits(const Subject& subject, Transport transport) {
  if (transport != Transport::kUdp) return true;
  FillOffer(subject);
  messages_->Encode(offer_, encoded_offer_);
  return encoded_offer_.size() <= protocol::kMaxUdpMessageBytes;
}

void PoseRelay::SendSkeleton(const Subscription& subscription) {
  FillOffer(*subscription.subject);
  messages_->SendReply(*subscription.peer,
                       {.stream = subscription.id, .sequence = subscription.request_sequence},
                       offer_);
}

void PoseRelay::SendPose(Subscription& subscription, std::span<const std::uint8_t> payload,
                         PublishContext* context) {
  const Subject& subject = *subscription.subject;
  const SubjectPipeline& pipeline = *subject.pipeline;
  const protocol::Header header{.stream = subscription.id,
                                .sequence = pipeline.sequence(),
                                .capture_time_us = pipeline.capture_time_us()};
  const std::size_t keep = subscription.every ? kKeepAll : kMaxQueuedPoses;
  Peer& peer = *subscription.peer;
  // The usual case copies the bytes of the publisher under a new envelope: no decoding loss, and no
  // cost per joint.
  if (!payload.empty()) {
    subscription.dropped +=
        context->messages
            .SendEncodedFrame(peer, subscription.uid, header, payload, Counter::kPosesRelayed,
                              Counter::kPosesDroppedSlow, keep)
            .dropped;
    return;
  }
  // A partial pose or a foreign wire. A whole pose needs nothing that the subscriber may have
  // missed.
  ToWholePose(pipeline.pose(), pipeline.stream(), &context->pose);
  context->pose.skeleton_hash = subject.skeleton_hash;
  context->pose.timecode = subject.timecode;
  subscription.dropped += context->messages
                              .SendFrame(peer, subscription.uid, header, context->pose,
                                         Counter::kPosesRelayed, Counter::kPosesDroppedSlow, keep)
                              .dropped;
}

void PoseRelay::ReportDropped(Subscription& subscription, Time now) {
  if (!subscription.every || subscription.dropped == subscription.reported_dropped) return;
  // A report per dropped frame would add to the queue that is already too long.
  if (now - subscription.reported < kReportInterval) return;
  subscription.reported = now;
  subscription.reported_dropped = subscription.dropped;
  messages_->SendReply(*subscription.peer,
                       {.stream = subscription.id, .sequence = subscription.request_sequence},
                       protocol::Dropped{subscription.dropped});
}

}  // namespace furrow::server
