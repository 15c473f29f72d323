// SPDX-License-Identifier: Apache-2.0
#include "server/session/hub.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;

constexpr Time kUdpLease = std::chrono::microseconds(protocol::kUdpLeaseMicroseconds);

// What a hub of so many lanes begins with.
std::vector<std::unique_ptr<Lane>> MakeLanes(const Hub::Parts& parts) {
  std::vector<std::unique_ptr<Lane>> lanes;
  for (int i = 0; i < parts.lanes; ++i) {
    lanes.push_back(std::make_unique<Lane>(i, parts.lanes, parts.session, parts.metrics));
  }
  return lanes;
}

}  // namespace

Hub::Hub(Parts parts)
    : limits_(parts.limits),
      metrics_(parts.metrics),
      make_token_(std::move(parts.make_token)),
      on_weights_(std::move(parts.on_weights)),
      recording_(parts.recording),
      gates_(parts.lanes),
      lanes_(MakeLanes(parts)),
      desk_(parts.session, metrics_, Link::kAlone),
      postman_(desk_.postman),
      definitions_(std::move(parts.rig), parts.character,
                   static_cast<std::size_t>(parts.limits.max_skeletons),
                   std::move(parts.skeletons)),
      publishers_(limits_, &definitions_, &subjects_, &postman_, metrics_),
      subscribers_(limits_, &subjects_, parts.pictures, parts.settings,
                   recording_ != nullptr || on_weights_ != nullptr, &desk_, metrics_) {}

Hub::Turn::Turn(Hub& hub, int lane) : hub_(hub), lane_(hub.LaneAt(lane)) {
  if (lane_.turns++ == 0 && lane_.alone == 0) hub_.gates_.Enter(lane_.index);
}

Hub::Turn::~Turn() {
  if (lane_.turns == 1) {
    hub_.PublishGathered(lane_);
    Flush(lane_);
  }
  if (--lane_.turns == 0 && lane_.alone == 0) hub_.gates_.Leave(lane_.index);
}

Hub::Alone::Alone(Hub& hub, int lane) : hub_(hub), lane_(hub.LaneAt(lane)) {
  hub_.PublishGathered(lane_);
  if (lane_.alone++ > 0 || hub_.lanes_.size() == 1) return;
  if (lane_.turns > 0) {
    // Before another may send of the same subjects.
    Flush(lane_);
    hub_.gates_.Leave(lane_.index);
  }
  hub_.gates_.EnterAlone();
}

Hub::Alone::~Alone() {
  if (--lane_.alone > 0) return;
  const bool ends_turn = hub_.lanes_.size() == 1 && lane_.turns > 0;
  if (ends_turn) return;  // which sends what there is
  for (const auto& lane : hub_.lanes_) Flush(*lane);
  if (hub_.lanes_.size() == 1) return;
  if (lane_.turns > 0) {
    hub_.gates_.LeaveAloneInto(lane_.index);
  } else {
    hub_.gates_.LeaveAlone();
  }
}

void Hub::Flush(Lane& lane) {
  if (lane.outlet != nullptr) lane.outlet->Flush();
}

PeerId Hub::AddPeer(Transport transport, std::string name, Link* link, Time now, int lane) {
  const Turn turn(*this, lane);
  const TokenBucket bucket(limits_.packets_per_second, limits_.packet_burst);
  return LaneAt(lane).peers.Add(transport, std::move(name), link, bucket, now).id;
}

void Hub::RemovePeer(PeerId id) {
  Lane& lane = LaneOf(id);
  const Turn turn(*this, lane.index);
  Peer* peer = lane.peers.Find(id);
  if (peer == nullptr) return;
  // A stranger, such as every forged address that is evicted, is nobody else's concern.
  if (peer->publishes || peer->num_subscriptions > 0) {
    const Alone alone(*this, lane.index);
    subscribers_.RemovePeer(*peer);
    if (peer->publishes) subjects_.ForgetPeer(id);
  }
  lane.peers.Remove(id);
}

void Hub::OnBytesReceived(PeerId id, std::size_t bytes, Time now) {
  if (Peer* peer = LaneOf(id).peers.Find(id); peer != nullptr) {
    peer->credit.Received(bytes);
    peer->last_heard = now;
  }
}

void Hub::OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  Lane& lane = LaneOf(id);
  const Turn turn(*this, lane.index);
  GatherMessage(id, bytes, now);
  PublishGathered(lane);
}

void Hub::GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  Lane& lane = LaneOf(id);
  Peer* peer = lane.peers.Find(id);
  if (peer == nullptr) return;
  metrics_->Add(Counter::kMessagesReceived);
  if (!peer->bucket.Take(now)) {
    metrics_->Add(Counter::kMessagesThrottled);
    return;
  }
  peer->last_heard = now;
  protocol::MessageView view;
  const DecodeStatus status = protocol::OpenMessage(bytes, view);
  // Whatever else it asks for or changes, the poses before it come first.
  if (status != DecodeStatus::kOk || view.kind != MessageKind::kPose) PublishGathered(lane);
  if (status == DecodeStatus::kOk) {
    Dispatch(lane, *peer, view, now);
  } else {
    RefuseEnvelope(lane, *peer, view, status);
  }
}

// False: refused.
bool Hub::OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
                  Time now) {
  Subject* subject = publishers_.OnOffer(peer, header, offer, now);
  if (subject == nullptr) return false;
  subscribers_.OnSubjectReady(*subject);
  if (recording_ != nullptr) recording_->OnOffer(*subject, offer, now);
  return true;
}

// `payload`: as RecordingTap::OnPose() takes it.
void Hub::OnPose(Lane& lane, Peer& peer, const protocol::Header& header,
                 const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time now) {
  Subject* subject = publishers_.Find(peer, header, pose);
  // An answer comes after the poses before it, and a subject's next pose builds on its last.
  const bool may_wait = subject != nullptr && !subject->pipeline->waits() && !lane.gathered.full();
  if (!may_wait) PublishGathered(lane);
  if (subject == nullptr) {
    publishers_.OnStray(peer, header, pose.skeleton_hash, lane.desk.postman, now);
  } else if (publishers_.Take(*subject, header, pose)) {
    lane.gathered.Add({.subject = subject, .header = header, .payload = payload, .now = now});
  }
}

void Hub::PublishGathered(Lane& lane) {
  if (lane.gathered.empty()) return;
  for (const GatheredPose& pose : lane.gathered.Solve()) {
    if (!publishers_.OnSolved(pose)) continue;
    if (recording_ != nullptr) recording_->OnPose(*pose.subject, pose.payload, pose.now);
    Weighted(lane, *pose.subject, pose.payload, 0, pose.now);
  }
}

void Hub::Weighted(Lane& lane, Subject& subject, std::span<const std::uint8_t> pose,
                   std::int64_t age_us, Time now) {
  // Behind its Goodbye nobody gets anything.
  if (!draining_) {
    subscribers_.Publish(subject, pose, age_us, now, lane.alone > 0 ? &desk_ : &lane.desk);
  }
  if (on_weights_) on_weights_(subject, lane.index);
  if (recording_ != nullptr) recording_->OnWeights(subject, age_us, now);
}

void Hub::OnPicture(const FinishedPicture& picture) {
  const Alone alone(*this, 0);
  if (!draining_) subscribers_.OnPicture(picture);
}

// And ages who is there.
void Hub::RemoveGone(Time now) {
  std::vector<Subject*> gone;
  for (const auto& subject : subjects_.all()) {
    switch (publishers_.Age(*subject, now)) {
      case Publishers::Change::kNone: break;
      case Publishers::Change::kDecayed:
        Weighted(*lanes_.front(), *subject, {}, ToMicroseconds(now - subject->last_pose), now);
        break;
      case Publishers::Change::kGone: gone.push_back(subject.get()); break;
    }
  }
  for (Subject* subject : gone) {
    spdlog::info("subject '{}' is gone", subject->name);
    subscribers_.OnSubjectGone(*subject);
    if (recording_ != nullptr) recording_->OnSubjectGone(*subject);
    std::erase_if(mocap_streams_,
                  [subject](const auto& entry) { return entry.first.second == subject->name; });
    subjects_.Remove(subject->id);
  }
  if (!gone.empty()) subscribers_.BindWaiting();
}

void Hub::Tick(Time now) {
  const Alone alone(*this, 0);
  RemoveGone(now);
  ForgetRefusedMocap(now);
  ForEachPeer([now](Peer& peer) { peer.stuck = peer.link->IsStuck(now); });
  if (!draining_) subscribers_.PublishOwed(now);
  ForEachPeer([&](Peer& peer) {
    if (peer.follows_list && peer.listed != subjects_.version()) SendList(peer, *peer.follows_list);
    if (peer.transport != Transport::kUdp || now - peer.last_heard < kUdpLease) return;
    if (peer.num_subscriptions > 0) {
      subscribers_.RemovePeer(peer, protocol::GoodbyeReason::kTimedOut);
    }
    peer.credit = {};  // proven for as long as it is heard
  });
}

void Hub::Drain() {
  const Alone alone(*this, 0);
  draining_ = true;
  ForEachPeer([&](Peer& peer) {
    if (peer.transport == Transport::kMocap) return;
    postman_.Reply(peer, {}, protocol::Goodbye{protocol::GoodbyeReason::kDraining});
  });
}

bool Hub::IsIdle(PeerId id, Time now) {
  Lane& lane = LaneOf(id);
  const Turn turn(*this, lane.index);
  const Peer* peer = lane.peers.Find(id);
  return peer == nullptr || (peer->num_subscriptions == 0 &&
                             now - peer->last_heard > FromSeconds(limits_.idle_seconds));
}

bool Hub::IsLessWorthKeeping(PeerId a, PeerId b) {
  const auto worth = [this](PeerId id) {
    const Peer* peer = LaneOf(id).peers.Find(id);
    return std::pair(peer->publishes || peer->num_subscriptions > 0, peer->last_heard);
  };
  return worth(a) < worth(b);
}

}  // namespace furrow::server
