// SPDX-License-Identifier: Apache-2.0
// The part of Subscribers that hands skeletons and poses on as they were used.
#include <variant>

#include "protocol/messages/limits.h"
#include "server/pipeline/wire_adapter.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {
namespace {

// How many poses may wait for a slow peer that does not want every one.
constexpr std::size_t kPosesKept = 4;
constexpr Time kTellInterval = std::chrono::seconds(1);

}  // namespace

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribePoses& request) {
  if (!MayAdd(peer, header)) return;
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  subscription->wish = PosesWish();
  subscription->every = request.every && peer.transport != Transport::kUdp;
  Add(peer, header, std::move(subscription));
}

// Says who publishes, and what its poses mean.
bool Subscribers::BindPoses(Subscription& subscription, PosesWish& wish, Subject& subject) {
  offer_ = *subject.offer;
  offer_.subject = subject.name;
  postman_->Encode(offer_, encoded_offer_);
  if (subscription.peer->transport == Transport::kUdp &&
      encoded_offer_.size() > protocol::kMaxUdpMessageBytes) {
    Refuse(subscription, protocol::ErrorCode::kLimit,
           "the skeleton of '" + subject.name + "' is more than UDP carries: ask over TCP");
    return false;
  }
  wish = {subject.owner.session, subject.skeleton_hash};
  Attach(subscription, subject);
  Reply(subscription, {});
  postman_->Reply(*subscription.peer, {.stream = subscription.id, .sequence = subscription.request},
                  offer_);
  return true;
}

void Subscribers::SendPose(Subscription& subscription, std::span<const std::uint8_t> pose,
                           Desk* desk) {
  const Subject& subject = *subscription.subject;
  const SubjectPipeline& pipeline = *subject.pipeline;
  const protocol::Header header{.stream = subscription.id,
                                .sequence = pipeline.sequence(),
                                .capture_time_us = pipeline.capture_time_us()};
  const std::size_t keep = subscription.every ? kKeepAll : kPosesKept;
  Peer& peer = *subscription.peer;
  if (!pose.empty()) {
    subscription.dropped +=
        desk->postman.Forward(peer, subscription.uid, header, pose, Counter::kPosesRelayed,
                              Counter::kPosesDroppedSlow, keep);
    return;
  }
  ToWholePose(pipeline.pose(), pipeline.stream(), &desk->pose);
  desk->pose.skeleton_hash = subject.skeleton_hash;
  subscription.dropped +=
      desk->postman.Frame(peer, subscription.uid, header, desk->pose, Counter::kPosesRelayed,
                          Counter::kPosesDroppedSlow, keep);
}

// Whoever wants every frame hears what it does not get, but not so often that it would get less.
void Subscribers::TellDropped(Subscription& subscription, Time now) {
  if (!subscription.every || subscription.dropped == subscription.told_dropped) return;
  if (now - subscription.told < kTellInterval) return;
  subscription.told = now;
  subscription.told_dropped = subscription.dropped;
  postman_->Reply(*subscription.peer, {.stream = subscription.id, .sequence = subscription.request},
                  protocol::Dropped{subscription.dropped});
}

}  // namespace furrow::server
