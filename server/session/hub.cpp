// SPDX-License-Identifier: Apache-2.0
#include "server/session/hub.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <tuple>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "protocol/messages/limits.h"
#include "server/session/peers/peer_access.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;

constexpr Time kUdpLease = std::chrono::microseconds(protocol::kUdpLeaseMicroseconds);

AddressProof::Key MakeKey(const std::function<std::uint64_t()>& random) {
  const std::array<std::uint64_t, 4> numbers = {random(), random(), random(), random()};
  return std::bit_cast<AddressProof::Key>(numbers);
}

}  // namespace

// The members point at each other, so their order in the class is the order of construction: what a
// part uses comes before it. Publishers and Subscribers run under the exclusive lock, and therefore
// share the one exclusive context; each shard has a context of its own.
Hub::Hub(Parts parts)
    : limits_(parts.limits),
      session_(parts.session),
      metrics_(parts.metrics),
      random_(std::move(parts.random)),
      address_proof_(MakeKey(random_)),
      recording_(parts.recording),
      gate_(parts.gate),
      tracer_(parts.clock ? std::make_unique<PoseTracer>(std::move(parts.clock)) : nullptr),
      exclusive_context_(parts.session, metrics_, Link::kExclusive),
      definitions_(std::move(parts.rig), parts.character,
                   static_cast<std::size_t>(parts.limits.max_skeletons),
                   {std::move(parts.skeletons), std::move(parts.shape_matcher)}),
      subjects_(static_cast<std::size_t>(limits_.max_subjects)),
      places_(parts.cluster, static_cast<std::size_t>(limits_.max_subjects)),
      publishers_(limits_, JitterDelays(parts.jitter), &definitions_, &subjects_,
                  &exclusive_context_.messages, &places_, &arrivals_, random_, metrics_),
      subscribers_(limits_, &subjects_, parts.pictures, parts.settings,
                   /*all_drivers=*/recording_ != nullptr, &places_, &exclusive_context_, metrics_),
      router_({.publishers = &publishers_,
               .subscribers = &subscribers_,
               .subjects = &subjects_,
               .exclusive_context = &exclusive_context_,
               .recording = recording_,
               .tracer = tracer_.get()}),
      shards_(parts.shards, parts.session, metrics_, &router_),
      dispatcher_({.shards = &shards_,
                   .router = &router_,
                   .publishers = &publishers_,
                   .subscribers = &subscribers_,
                   .subjects = &subjects_,
                   .messages = &exclusive_context_.messages,
                   .metrics = metrics_,
                   .gate = gate_,
                   .places = &places_,
                   .arrivals = &arrivals_,
                   .limits = &limits_,
                   .drain = std::move(parts.drain),
                   .is_own_address = std::move(parts.is_own_address),
                   .adopt_captures =
                       [this](const protocol::SubjectState& state, Time now) {
                         live_rig_.AdoptCaptures(state, kMaxAddedPoses, now);
                       }}),
      mocap_(limits_, &shards_, &router_, metrics_),
      live_rig_({.definitions = &definitions_,
                 .subjects = &subjects_,
                 .subscribers = &subscribers_,
                 .router = &router_,
                 .shards = &shards_,
                 .recording = recording_}),
      departures_({.places = &places_,
                   .subjects = &subjects_,
                   .publishers = &publishers_,
                   .subscribers = &subscribers_,
                   .router = &router_,
                   .shards = &shards_,
                   .messages = &exclusive_context_.messages,
                   .remove = [this](Subject& subject) { RemoveSubject(subject); }}),
      restart_({.subjects = &subjects_,
                .subscribers = &subscribers_,
                .router = &router_,
                .shards = &shards_,
                .adopt_captures =
                    [this](const protocol::SubjectState& state, Time now) {
                      live_rig_.AdoptCaptures(state, kMaxAddedPoses, now);
                    }}),
      holds_poses_(JitterDelays(std::move(parts.jitter)).any()) {}

PeerId Hub::AddPeer(Transport transport, PeerLabel name, Link* link, Time now, int shard,
                    std::optional<Access> access) {
  // An address book of one shard changes under its shard lock alone, so a new peer stops nobody
  // else.
  const ShardLock lock(*this, shard);
  const TokenBucket bucket(limits_.packets_per_second, limits_.packet_burst);
  Peer& peer = shards_.at(shard).peers.Add(transport, std::move(name), link, bucket, now);
  const bool trusted = gate_ == nullptr || transport == Transport::kMocap;
  Permit(peer, access ? *access : trusted ? Access::Everything() : gate_->Stranger(), limits_);
  return peer.id;
}

void Hub::SetAccess(PeerId id, const Access& access) {
  Shard& shard = shards_.Of(id);
  Peer* const peer = shard.peers.Find(id);
  if (peer == nullptr) return;
  const ExclusiveLock exclusive(*this, shard.index);
  Permit(*peer, access, limits_);
  subscribers_.EndForbidden(*peer);
  publishers_.EndForbidden(*peer, peer->last_heard);
}

// Over UDP the secure session ends by itself, and nothing can be sent in it afterwards.
void Hub::EndIfTokenEnded(Peer& peer, Time now) {
  if (!peer.access.by_token() || peer.transport == Transport::kUdp || peer.token_ended) return;
  const bool expired = now >= peer.access.expires();
  if (!expired && gate_->HasKey(peer.access.key_id())) return;
  metrics_->Add(Counter::kTokensEnded);
  const char* const why = expired ? "the token has expired" : "the key of the token was retired";
  spdlog::warn("closing the connection of {}: {}", peer.name, why);
  exclusive_context_.messages.SendError(peer, {}, ErrorCode::kNeedsToken, why);
  Permit(peer, Access(), limits_);
  subscribers_.RemovePeer(peer);
  subjects_.ForgetPeer(peer.id);
  dispatcher_.CutOff(peer);
}

void Hub::RemovePeer(PeerId id) {
  Shard& shard = shards_.Of(id);
  const ShardLock lock(*this, shard.index);
  Peer* peer = shard.peers.Find(id);
  if (peer == nullptr) return;
  // The pointer stays valid while the exclusive lock is being taken, although the shard is unlocked
  // for a moment: only this thread removes peers of this shard.
  // Only peers that take part in the session need the exclusive lock, which stops the other shards.
  if (peer->publishes || peer->num_subscriptions > 0) {
    const ExclusiveLock exclusive(*this, shard.index);
    subscribers_.RemovePeer(*peer);
    if (peer->publishes) subjects_.ForgetPeer(id);
  }
  shard.peers.Remove(id);
}

std::optional<Consent> Hub::ConsentOf(PeerId id) {
  const Peer* peer = shards_.Of(id).peers.Find(id);
  return peer == nullptr ? std::nullopt : std::optional(peer->consent);
}

void Hub::SetConsent(PeerId id, const Consent& consent) {
  if (Peer* peer = shards_.Of(id).peers.Find(id); peer != nullptr) peer->consent = consent;
}

void Hub::OnFragment(PeerId id, Time now) {
  if (Peer* peer = shards_.Of(id).peers.Find(id); peer != nullptr) peer->last_heard = now;
}

void Hub::OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  Shard& shard = shards_.Of(id);
  const ShardLock lock(*this, shard.index);
  GatherMessage(id, bytes, now);
  // The caller may reuse `bytes` afterwards, so a pose must not stay in the batch.
  router_.PublishGathered(shard);
}

void Hub::GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  if (Peer* peer = FindPeer(id); peer != nullptr) GatherMessage(*peer, bytes, now);
}

void Hub::GatherMessage(Peer& peer, std::span<const std::uint8_t> bytes, Time now) {
  metrics_->Add(Counter::kMessagesReceived);
  // Before anything is verified or decoded: a flood must cost less than the work that it asks for.
  if (!peer.bucket.Take(now)) {
    metrics_->Add(Counter::kMessagesThrottled);
    return;
  }
  peer.last_heard = now;
  dispatcher_.Dispatch(shards_.Of(peer.id), peer, bytes, now);
}

void Hub::OnBadFrame(PeerId id) {
  Shard& shard = shards_.Of(id);
  const ShardLock lock(*this, shard.index);
  if (Peer* peer = shard.peers.Find(id); peer != nullptr) {
    // The limit of strangers is lower, and they learn nothing else.
    if (!peer->access.admitted()) return dispatcher_.RefuseStranger(*peer);
    shard.context.messages.SendError(*peer, {}, ErrorCode::kMalformed,
                                     "invalid frame length; a frame has 32 to " +
                                         std::to_string(protocol::kMaxRequestBytes) +
                                         " bytes and follows its length (u32, little-endian)");
  }
}

void Hub::RefuseConnection(Link* link, ErrorCode code, const std::string& why) {
  const ShardLock lock(*this, 0);
  Peer peer;  // never added: it only carries the link
  peer.link = link;
  shards_.at(0).context.messages.SendError(peer, {}, code, why);
}

bool Hub::HasNoUse(const Peer& peer, Time now) {
  if (peer.num_bound > 0 || peer.token_ended) return false;
  const bool waits = peer.num_subscriptions > 0 && !peer.publishes;
  return waits || now - peer.last_used >= kUnusedPatience;
}

bool Hub::MakeRoom(Transport transport, const std::string& host, bool any_host, Time now) {
  const ExclusiveLock lock(*this, 0);
  Peer* longest = nullptr;
  shards_.ForEachPeer([&](Peer& peer) {
    if (peer.transport != transport || !HasNoUse(peer, now)) return;
    if (!any_host && peer.host != host) return;
    // Those without a token first, then those without use for longest, then those that connected
    // first: ids count up.
    const auto order = [](const Peer& each) {
      return std::tuple(each.access.admitted(), each.last_used, each.id);
    };
    if (longest == nullptr || order(peer) < order(*longest)) {
      longest = &peer;
    }
  });
  if (longest == nullptr) return false;
  metrics_->Add(Counter::kConnectionsGaveWay);
  exclusive_context_.messages.SendError(
      *longest, {}, ErrorCode::kLimit,
      "closed to make room for a newcomer, because this connection only waited and all places are "
      "taken; see limits.max_connections and http.max_connections");
  subscribers_.RemovePeer(*longest);
  dispatcher_.CutOff(*longest, /*soon=*/true);
  return true;
}

void Hub::OnMocapFrame(PeerId id, const protocol::mocap::NeutralFrame& frame, Time now) {
  Shard& shard = shards_.Of(id);
  const ShardLock lock(*this, shard.index);
  if (Peer* peer = shard.peers.Find(id); peer != nullptr) mocap_.OnFrame(shard, *peer, frame, now);
}

void Hub::ReleaseHeld(int index, Time now) {
  const ShardLock lock(*this, index);
  router_.ReleaseHeld(shards_.at(index), now);
}

bool Hub::IsIdle(PeerId id, Time now) {
  Shard& shard = shards_.Of(id);
  const ShardLock lock(*this, shard.index);
  const Peer* peer = shard.peers.Find(id);
  if (peer == nullptr || peer->token_ended) return true;
  Time patience = FromSeconds(limits_.idle_seconds);
  if (!peer->access.admitted()) patience = std::min(patience, kStrangerPatience);
  return peer->num_subscriptions == 0 && now - peer->last_heard > patience;
}

void Hub::OnPicture(const FinishedPicture& picture, Time now) {
  const ExclusiveLock lock(*this, 0);
  if (draining_) return;
  subscribers_.OnPicture(picture, now);
  if (tracer_) tracer_->OnPicture(picture);
}

void Hub::Tick(Time now, Time late) {
  // The order matters. Subjects age first, so that owed frames carry the decayed weights. `stuck`
  // is read by all shards, so it changes only here, under the exclusive lock. Owed frames come
  // after that, so that a peer that reads again gets its newest pose in this tick.
  const ExclusiveLock lock(*this, 0);
  if (late >= kStall) OnStall(now, late);
  AgeSubjects(now);
  if (places_.in_cluster() && !draining_) {
    publishers_.AskAgain([this](PeerId id) { return shards_.FindPeer(id); }, now);
    if (now - places_refreshed_ >= Places::kRefresh) RefreshPlaces(now);
  }
  mocap_.ForgetRejected(now);
  shards_.ForEachPeer([&](Peer& peer) {
    EndIfTokenEnded(peer, now);
    if (peer.transport == Transport::kUdp) RenewConsent(peer, now);
    if (peer.num_bound > 0) peer.last_used = now;
    peer.stuck =
        peer.link->IsStuck(now) || (peer.transport == Transport::kUdp && !peer.consent.Holds(now));
  });
  if (!draining_) subscribers_.fan_out().SendOwed(now);
  shards_.ForEachPeer([&](Peer& peer) { dispatcher_.UpdateSubjectList(peer); });
}

void Hub::OnStall(Time now, Time length) {
  metrics_->Add(Counter::kStalls);
  // Rare, since it takes as long itself: no limit is needed.
  if (length >= FromSeconds(limits_.loss_seconds)) {
    spdlog::warn("the daemon did not run for {:.1f} s, because this computer was busy or paused it",
                 ToSeconds(length));
  }
  publishers_.OnStall(now);
  shards_.ForEachPeer([&](Peer& peer) {
    peer.last_heard += length;
    peer.consent.OnStall(length);
  });
}

void Hub::AgeSubjects(Time now) {
  // Removal waits for the end of the loop, because it erases from the list that the loop walks.
  std::vector<Subject*> gone;
  for (const auto& subject : subjects_.all()) {
    // Shard 0's thread runs the tick and may publish any subject, because all shards are locked.
    switch (publishers_.AgeSubject(*subject, now)) {
      case Publishers::Change::kNone: break;
      case Publishers::Change::kDecayed:
        router_.PublishAged(shards_.at(0), *subject, ToMicroseconds(now - subject->last_pose), now);
        break;
      case Publishers::Change::kGone: gone.push_back(subject.get()); break;
    }
  }
  for (Subject* subject : gone) RemoveSubject(*subject);
  // Subscriptions without a name fall back to the oldest subject that is left.
  if (!gone.empty()) subscribers_.BindWaiting();
}

void Hub::RemoveSubject(Subject& subject) {
  spdlog::info("subject '{}' has left", subject.name);
  // Everything that refers to the subject lets go of it before the registry frees it.
  subscribers_.OnSubjectGone(subject);
  if (recording_ != nullptr) recording_->OnSubjectGone(subject);
  mocap_.ForgetSubject(subject.name);
  places_.Release(subject.name);
  subjects_.Remove(subject.id);
}

void Hub::RefreshPlaces(Time now) {
  places_refreshed_ = now;
  departures_.RenewPlaces(now);
  subscribers_.SendWaitingElsewhere();
  arrivals_.Expire(now);
  FreeLevels(now);
  places_.Expire([this](std::string_view subject) { return subjects_.Find(subject) != nullptr; },
                 now);
}

// The subscribers of a subject that came from another node have followed it by now.
void Hub::FreeLevels(Time now) {
  for (const auto& subject : subjects_.all()) {
    if (!subject->keeps_level || now < subject->level_kept_until) continue;
    subject->keeps_level = false;
    subscribers_.UpdateDriverLevel(*subject);
  }
}

// A UDP address has no connection that could close. Publishing needs no consent: silence ends a
// subject through Limits::loss_seconds and idle_seconds.
void Hub::RenewConsent(Peer& peer, Time now) {
  if (peer.num_subscriptions > 0 && now - peer.consent.answered() >= kUdpLease) {
    subscribers_.RemovePeer(peer, protocol::GoodbyeReason::kTimedOut);
  }
  const bool needed = peer.num_subscriptions > 0 || peer.consent.wanted();
  if (!needed || !peer.consent.ChallengeDue(now)) return;
  // The wire's times are within 62 bits.
  const auto number = static_cast<std::int64_t>(random_() >> 2);
  peer.consent.Sent(number, now);
  exclusive_context_.messages.SendChallenge(peer, number);
}

void Hub::Drain(Time now) {
  const ExclusiveLock lock(*this, 0);
  departures_.SendAllAway(now);
  // Stop all frames before the goodbye, which must be the last message that a peer receives.
  draining_ = true;
  router_.StopFanOut();
  dispatcher_.RefuseSubscriptions();
  shards_.ForEachPeer([&](Peer& peer) {
    if (peer.transport == Transport::kMocap || peer.goes_on_elsewhere) return;
    // Stream 0 addresses the whole peer, not one of its subscriptions.
    exclusive_context_.messages.SendReply(peer, {},
                                          protocol::Goodbye{protocol::GoodbyeReason::kDraining});
  });
}

void Hub::TakeNothingNew() {
  const ExclusiveLock lock(*this, 0);
  places_.SetDraining();
}

std::vector<std::string> Hub::SubjectNames() {
  const ExclusiveLock lock(*this, 0);
  std::vector<std::string> names;
  for (const auto& subject : subjects_.all()) names.push_back(subject->name);
  return names;
}

Place Hub::SuccessorOf(std::string_view name, Time now, const std::set<std::string>& without) {
  const ExclusiveLock lock(*this, 0);
  return departures_.SuccessorOf(name, now, without);
}

bool Hub::WriteState(std::string_view name, std::uint32_t number,
                     std::vector<std::uint8_t>& message) {
  const ExclusiveLock lock(*this, 0);
  return departures_.WriteState(name, number, message);
}

Status Hub::HandOver(std::string_view name, const NodeAddress& node, std::uint32_t number,
                     std::vector<std::uint8_t>& message, Time now) {
  const ExclusiveLock lock(*this, 0);
  return departures_.HandOver(name, node, number, message, now);
}

bool Hub::MaySavePeer(PeerId id) {
  const ExclusiveLock lock(*this, 0);
  const Peer* const peer = shards_.FindPeer(id);
  return peer != nullptr && restart_.MaySave(*peer);
}

std::optional<SavedPeer> Hub::SavePeer(PeerId id) {
  const ExclusiveLock lock(*this, 0);
  Peer* const peer = shards_.FindPeer(id);
  return peer == nullptr ? std::nullopt : restart_.Save(*peer);
}

void Hub::KeepPeers() {
  const ExclusiveLock lock(*this, 0);
  shards_.ForEachPeer([](Peer& peer) { peer.goes_on_elsewhere = false; });
}

std::vector<SavedSubject> Hub::SaveSubjects(Time now) {
  const ExclusiveLock lock(*this, 0);
  return restart_.SaveSubjects(now);
}

void Hub::Resume(const std::vector<SavedSubject>& subjects, const ResumedPeers& peers, Time away,
                 Time now) {
  const ExclusiveLock lock(*this, 0);
  for (const SavedSubject& subject : subjects) {
    const auto owner = peers.find(subject.owner);
    Peer* const peer = owner == peers.end() ? nullptr : shards_.FindPeer(owner->second.id);
    restart_.Resume(subject, peer, away, now);
  }
  for (const auto& [former, known] : peers) {
    if (Peer* const peer = shards_.FindPeer(known.id); peer != nullptr) {
      restart_.Resume(*peer, *known.saved, away);
    }
  }
}

// An empty name: the oldest subject.
Subject* Hub::FindFor(std::string_view name, const Access& access) {
  Subject* subject = name.empty() ? subjects_.First(access) : subjects_.Find(name);
  return subject != nullptr && access.Concerns(subject->name) ? subject : nullptr;
}

Subject* Hub::RequireAllDrivers(std::string_view name, const Access& access) {
  Subject* subject = FindFor(name, access);
  if (subject == nullptr) return nullptr;
  // Stays set, since clients of the API poll: a driver that is switched off and on again starts
  // without the history of its filter.
  subject->needs_all_drivers = true;
  subject->pipeline->SetLevel(wrinkle::kAllDrivers);
  return subject;
}

const Subject* Hub::Trace(std::string_view name, const Access& access) {
  const Subject* subject = FindFor(name, access);
  if (subject != nullptr && tracer_) tracer_->Request(subject->id, subject->name);
  return subject;
}

std::string_view Hub::SourceOf(const Subject& subject) {
  // A subject outlives its publisher while it decays, so the peer may be gone.
  const Peer* peer = shards_.FindPeer(subject.owner.peer);
  return peer == nullptr ? std::string_view() : std::string_view(peer->name);
}

void Hub::SetLimits(const Limits& limits) {
  limits_ = limits;
  subjects_.SetMaxSubjects(static_cast<std::size_t>(limits.max_subjects));
  subscribers_.OnLimits();
  definitions_.SetCapacity(static_cast<std::size_t>(limits.max_skeletons));
}

void Hub::SetOnWeights(OnWeights on_weights) {
  subscribers_.SetAllDrivers(recording_ != nullptr || on_weights != nullptr);
  router_.SetOnWeights(std::move(on_weights));
}

}  // namespace furrow::server
