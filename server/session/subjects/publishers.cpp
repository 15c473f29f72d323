// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/publishers.h"

#include <algorithm>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/pipeline/wire_adapter.h"
#include "server/session/subjects/subject_state.h"

namespace furrow::server {
namespace {

// Weights of a lost subject change slowly, so a display's rate is enough whatever the tick's rate
// is.
constexpr Time kDecayInterval = FromSeconds(1.0 / 60.0);

// Subscribers follow their subject to another node within this time. Until then, the drivers that
// they needed go on.
constexpr Time kLevelKept = std::chrono::seconds(5);

// The shortest silence after which another sender gets a subject.
constexpr Time kTakeOver = FromSeconds(0.5);

// True if the peer chose its session number at random. Foreign wires and recordings have none.
bool HasSecretSession(const Peer& peer) {
  return peer.transport == Transport::kUdp || peer.transport == Transport::kTcp;
}

}  // namespace

Publishers::Publishers(const Limits& limits, JitterDelays delays, StreamDefinitions* definitions,
                       SubjectRegistry* subjects, MessageSender* messages, Places* places,
                       Arrivals* arrivals, std::function<std::uint64_t()> random, Metrics* metrics)
    : limits_(limits),
      delays_(std::move(delays)),
      definitions_(definitions),
      subjects_(subjects),
      messages_(messages),
      places_(places),
      arrivals_(arrivals),
      random_(std::move(random)),
      metrics_(metrics) {}

// Decides between five cases: a repeated offer, a subject that another sender is sending, or that
// comes here with another sender, too many subjects, and a stream that starts, restarts or takes
// over its subject.
Subject* Publishers::OnOffer(Peer& peer, const protocol::Header& header,
                             const protocol::SkeletonOffer& offer, Time now) {
  metrics_->Add(Counter::kSkeletonsOffered);
  if (!peer.access.MayPublish(offer.subject)) {
    metrics_->Add(Counter::kRefusedPublish);
    Reject(peer, header, offer.skeleton_hash,
           "not permitted to publish '" + offer.subject + "'; " + peer.access.Text(), now);
    return nullptr;
  }
  const StreamKey key{peer.id, header.session, header.stream};
  Subject* subject = subjects_->Find(offer.subject);
  const bool is_owner = subject != nullptr && subject->owner == key;
  const bool is_repeated = is_owner && subject->skeleton_hash == offer.skeleton_hash;
  // Before anything else: such an offer must neither ask for the place nor wait for it.
  if (subject == nullptr && arrivals_->IsReserved(offer.subject, header.session, now)) {
    Contest(peer, header, offer.subject);
    return nullptr;
  }
  const bool is_contested =
      subject != nullptr && !is_owner && IsContested(*subject, peer, key, now);
  // First: a node that is full sends the publisher to another one.
  const auto place = TakePlace(peer, header, offer, now);
  if (!place) return nullptr;
  if (is_repeated) {
    subject->ended = false;  // a repeated offer, or the sender is back after its goodbye
  } else if (is_contested) {
    Contest(peer, header, offer.subject);
    return nullptr;
  } else {
    auto definition = DefinitionFor(peer, header, offer, now);
    if (definition == nullptr) return nullptr;
    subject = Accept(peer, key, offer, std::move(definition), now);
    if (const auto arrived = arrivals_->Take(subject->name, now)) GoOn(*arrived, subject, now);
  }
  subject->served_until = place->until;
  subject->epoch = place->epoch;
  messages_->SendReply(
      peer, MessageSender::ReplyHeader(header),
      protocol::SkeletonReply{offer.skeleton_hash, protocol::SkeletonStatus::kAccepted, {}});
  return subject;
}

void Publishers::GoOn(const Arrivals::Arrived& arrived, Subject* subject, Time now) {
  ResumeFrom(arrived.header, arrived.state, subject);
  subject->level_kept_until = now + kLevelKept;
  subject->keeps_level = true;
}

Subject* Publishers::Resume(Peer& peer, const protocol::Header& header,
                            const protocol::SkeletonOffer& offer, const Arrivals::Arrived& arrived,
                            Time now) {
  const StreamKey key{peer.id, header.session, header.stream};
  if (subjects_->Find(offer.subject) != nullptr || subjects_->Find(key) != nullptr ||
      !peer.access.MayPublish(offer.subject) || !subjects_->HasRoomFor(peer.host)) {
    return nullptr;
  }
  // The former daemon has admitted the skeleton already.
  auto definition = definitions_->Get(ToStreamOffer(offer), [] { return true; });
  if (!definition.ok() || *definition == nullptr) return nullptr;
  Subject* const subject = Accept(peer, key, offer, *std::move(definition), now);
  GoOn(arrived, subject, now);
  return subject;
}

// Not a rejection: the sender repeats its offer, and takes over when the present one stops.
void Publishers::Contest(Peer& peer, const protocol::Header& header, const std::string& subject) {
  metrics_->Add(Counter::kSubjectsContested);
  messages_->SendError(
      peer, header, protocol::ErrorCode::kSubjectTaken,
      "another sender is sending '" + subject + "'; stop it, or send under another name");
}

// Null: the offer is answered, or must be repeated.
std::shared_ptr<const StreamDefinition> Publishers::DefinitionFor(
    Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer, Time now) {
  if (subjects_->Find(offer.subject) == nullptr && !subjects_->HasRoomFor(peer.host)) {
    const std::string why = "this address has its share of the " +
                            std::to_string(limits_.max_subjects) +
                            " subjects; see limits.max_subjects";
    // The publisher may have come from another node, and would keep a rejection for ever.
    if (places_->in_cluster()) {
      messages_->SendError(peer, header, protocol::ErrorCode::kLimit, why);
    } else {
      Reject(peer, header, offer.skeleton_hash, why, now);
    }
    return nullptr;
  }
  // Binding a skeleton to the rig takes milliseconds under the exclusive lock. Known skeletons
  // are free; new ones need a token, or a flood of random offers would stop the daemon.
  auto definition =
      definitions_->Get(ToStreamOffer(offer), [&] { return TakeNewSkeleton(peer.host, now); });
  if (!definition.ok()) {
    Reject(peer, header, offer.skeleton_hash, definition.status().ToString(), now);
    return nullptr;
  }
  // No reply: senders repeat their offer until it is answered.
  if (*definition == nullptr) {
    metrics_->Add(Counter::kSkeletonsThrottled);
    return nullptr;
  }
  return *std::move(definition);
}

// Nothing: the offer is answered, or waits for a place. Senders repeat it then.
std::optional<Place> Publishers::TakePlace(Peer& peer, const protocol::Header& header,
                                           const protocol::SkeletonOffer& offer, Time now) {
  const std::string& subject = offer.subject;
  Place place = places_->Ask(subject, now);
  if (place.kind == Place::Kind::kPending) {
    arrivals_->Await(subject, peer.id, header, offer.skeleton_hash, now);
    return std::nullopt;
  }
  arrivals_->StopWaiting(subject);
  switch (place.kind) {
    case Place::Kind::kHere: return place;
    case Place::Kind::kPending: return std::nullopt;
    case Place::Kind::kElsewhere:
      messages_->SendElsewhere(peer, header, protocol::ErrorCode::kSubjectTaken,
                               ElsewhereText(subject, place.node), place.node);
      return std::nullopt;
    case Place::Kind::kNowhere: break;
  }
  messages_->SendError(peer, header, protocol::ErrorCode::kLimit,
                       "'" + subject + "' has no place in the cluster: " + place.why);
  return std::nullopt;
}

// Sooner than the publisher would repeat its offer by itself.
void Publishers::AskAgain(const std::function<Peer*(PeerId)>& find_peer, Time now) {
  // Runs every 10 ms under the exclusive lock, so the others have their turn at the next call.
  constexpr std::size_t kMostAtOnce = 64;
  const auto& all = arrivals_->waiting();
  std::vector<std::string> here;
  auto next = all.upper_bound(asked_again_);
  for (std::size_t i = 0; i < std::min(kMostAtOnce, all.size()); ++i) {
    if (next == all.end()) next = all.begin();
    const auto& [subject, waiting] = *next++;
    asked_again_ = subject;
    if (places_->Renew(subject, now).kind != Place::Kind::kHere) continue;
    here.push_back(subject);
    Peer* const peer = find_peer(waiting.peer);
    if (peer == nullptr) continue;
    messages_->SendReply(
        *peer, MessageSender::ReplyHeader(waiting.offer),
        protocol::SkeletonReply{waiting.skeleton_hash, protocol::SkeletonStatus::kNeeded, {}});
  }
  for (const std::string& subject : here) arrivals_->StopWaiting(subject);
}

Place Publishers::RenewPlace(Subject& subject, Peer* owner, Time now) {
  Place place = places_->Renew(subject.name, now);
  if (place.kind == Place::Kind::kHere) {
    subject.served_until = place.until;
    subject.epoch = place.epoch;
    return place;
  }
  // The subject does not move because another node has room: this one may get it back.
  place = places_->Elsewhere(subject.name);
  if (place.kind == Place::Kind::kElsewhere) SendAway(subject, owner, place.node);
  return place;
}

void Publishers::SendAway(const Subject& subject, Peer* owner, const NodeAddress& node) {
  spdlog::info("subject '{}' goes on at the node '{}'", subject.name, node.name);
  if (owner == nullptr || subject.ended) return;
  messages_->SendElsewhere(*owner, {.stream = subject.owner.stream},
                           protocol::ErrorCode::kSubjectTaken, ElsewhereText(subject.name, node),
                           node);
}

// True if the host may offer another skeleton that the daemon does not know.
bool Publishers::TakeNewSkeleton(const std::string& host, Time now) {
  // Forgetting fills the buckets again, but the one of all hosts stays. So the memory is bounded.
  constexpr std::size_t kMaxHosts = 1024;
  if (new_skeletons_of_.size() >= kMaxHosts && !new_skeletons_of_.contains(host)) {
    new_skeletons_of_.clear();
  }
  const TokenBucket full(kShareOfHost * kNewSkeletonsPerSecond, kShareOfHost * kNewSkeletonsBurst);
  const bool common =
      new_skeletons_of_.try_emplace(host, full).first->second.Take(now) && new_skeletons_.Take(now);
  return common || (reserved_of_.Take(host, now) && reserved_.Take(now));
}

// Makes the stream the owner of the subject `offer.subject`, with a new pipeline.
Subject* Publishers::Accept(Peer& peer, const StreamKey& key, const protocol::SkeletonOffer& offer,
                            std::shared_ptr<const StreamDefinition> stream, Time now) {
  Subject* subject = subjects_->Find(offer.subject);
  // What allocates may fail, so it comes before what changes.
  auto pipeline = std::make_unique<SubjectPipeline>(std::move(stream));
  auto shared_offer = ShareOffer(offer);
  // The neutral pose belongs to the performer, so it survives a change of the sender.
  if (subject != nullptr && subject->skeleton_hash == offer.skeleton_hash) {
    pipeline->SetNeutral(subject->pipeline->neutral_pose());
  }
  // A stream feeds one subject. A new name on the stream ends the old subject.
  if (Subject* former = subjects_->Find(key); former != nullptr && former->name != offer.subject) {
    former->ended = true;
    subjects_->Release(*former);
  }
  const bool is_new = subject == nullptr;
  if (is_new) {
    subject = &subjects_->Add(offer.subject, peer.host, std::move(pipeline), now);
    subject->hold = delays_.Of(offer.subject);
    spdlog::info("subject '{}' from {}: {} joints, {} blend shapes", offer.subject, peer.name,
                 offer.joints.size(), offer.blend_shape_names.size());
  }
  const StreamKey former_owner = subject->owner;
  try {
    subjects_->SetOwner(*subject, key);
  } catch (const std::bad_alloc&) {
    if (is_new) subjects_->Remove(subject->id);
    throw;
  }
  // From here on nothing can fail.
  if (!is_new) subject->pipeline = std::move(pipeline);
  if (!is_new && former_owner != key) {
    metrics_->Add(Counter::kSubjectsRestarted);
    spdlog::info("{} has taken over subject '{}'", peer.name, offer.subject);
  }
  // A new stream numbers its poses from anywhere.
  if (former_owner != key) subject->window = {};
  // Subscribers learn this number, and not the session, which is the publisher's secret.
  if (former_owner.session != key.session) subject->run = random_();
  subject->can_move = HasSecretSession(peer);
  subject->reorders = peer.transport == Transport::kUdp;
  subject->reorders_until = Time{0};
  peer.publishes = true;
  subject->skeleton_hash = offer.skeleton_hash;
  subject->offer = std::move(shared_offer);
  subject->timecode.reset();
  // The time without poses counts from the offer, so that the subject is not lost before its first
  // pose.
  subject->last_pose = subject->last_update = now;
  subject->ended = subject->lost = subject->no_face = subject->orphaned = false;
  return subject;
}

// True if the subject belongs to another sender that is still sending. A publisher that comes from
// another address or by a new connection still has its session number, which nobody else knows.
bool Publishers::IsContested(const Subject& subject, const Peer& peer, const StreamKey& key,
                             Time now) const {
  if (subject.ended || subject.orphaned || subject.owner.session == 0) return false;
  const bool has_moved =
      subject.owner.session == key.session && subject.can_move && HasSecretSession(peer);
  if (has_moved || peer.id == subject.owner.peer) return false;
  const Time heard = std::max({subject.last_pose, subject.last_no_face, awake_since_});
  // Not sooner than kTakeOver: a quick decay must not give subjects away on a bad network.
  return now - heard < std::max(FromSeconds(limits_.loss_seconds), kTakeOver);
}

// Subjects with equal skeletons share one copy of the offer, which has kilobytes of names. An equal
// hash proves nothing, so the whole offer is compared.
std::shared_ptr<const protocol::SkeletonOffer> Publishers::ShareOffer(
    const protocol::SkeletonOffer& offer) {
  protocol::SkeletonOffer nameless = offer;
  nameless.subject.clear();
  std::erase_if(offers_, [](const auto& known) { return known.second.expired(); });
  const auto known = offers_[offer.skeleton_hash].lock();
  if (known != nullptr && *known == nameless) return known;
  auto shared = std::make_shared<const protocol::SkeletonOffer>(std::move(nameless));
  offers_[offer.skeleton_hash] = shared;
  return shared;
}

void Publishers::Reject(Peer& peer, const protocol::Header& header, std::uint64_t hash,
                        std::string why, Time now) {
  metrics_->Add(Counter::kSkeletonsRejected);
  if (log_bucket_.Take(now)) spdlog::warn("rejected a skeleton from {}: {}", peer.name, why);
  messages_->SendReply(peer, MessageSender::ReplyHeader(header),
                       protocol::SkeletonReply{hash, protocol::SkeletonStatus::kRejected,
                                               MessageSender::Truncate(std::move(why))});
}

Subject* Publishers::FindSubject(const Peer& peer, const protocol::Header& header,
                                 const protocol::PoseFrame& pose) {
  metrics_->Add(Counter::kPosesReceived);
  Subject* subject = subjects_->Find(StreamKey{peer.id, header.session, header.stream});
  // A pose of the skeleton before a change may arrive after the offer of the new one.
  return subject != nullptr && subject->skeleton_hash == pose.skeleton_hash ? subject : nullptr;
}

bool Publishers::AcceptPose(Subject& subject, const protocol::Header& header,
                            const protocol::PoseFrame& pose, Time now) {
  if (subject.ended) {  // the goodbye has overtaken this pose
    metrics_->Add(Counter::kPosesLate);
    return false;
  }
  if (now >= subject.served_until) {  // another node may serve it
    metrics_->Add(Counter::kPosesUnplaced);
    return false;
  }
  SubjectPipeline& pipeline = *subject.pipeline;
  if (!PoseFits(pose, pipeline.stream())) {
    metrics_->Add(Counter::kPosesInvalid);
    return false;
  }
  // After the check of the contents: an invalid pose must not use up its sequence number.
  if (!IsNew(subject, header, now)) return false;
  ApplyPose(pose, pipeline.stream(), pipeline.mutable_pose());
  return true;
}

void Publishers::OnRecovered() { metrics_->Add(Counter::kPosesRecovered); }

void Publishers::OnDuplicate(Subject& subject) {
  metrics_->Add(Counter::kPosesDuplicate);
  subject.stats.OnLate();
}

void Publishers::OnHeld(bool full) {
  metrics_->Add(Counter::kPosesHeld);
  if (full) metrics_->Add(Counter::kPosesHeldFull);
}

bool Publishers::OnSolved(const GatheredPose& pose) {
  if (pose.status != wrinkle::JobStatus::kOk) {
    metrics_->Add(Counter::kPosesInvalid);
    return false;
  }
  Subject& subject = *pose.subject;
  subject.last_pose = subject.last_update = pose.now;
  subject.lost = subject.no_face = false;
  subject.timecode = pose.timecode;
  subject.stats.OnPose(pose.header.sequence, pose.header.capture_time_us, pose.now);
  return true;
}

void Publishers::OnNoFace(const Peer& peer, const protocol::Header& header, Time now) {
  Subject* subject = subjects_->Find(StreamKey{peer.id, header.session, header.stream});
  if (subject == nullptr || subject->ended) return;
  if (!subject->no_face) spdlog::info("subject '{}' shows no face", subject->name);
  subject->no_face = true;
  subject->last_no_face = now;
}

bool Publishers::IsNew(Subject& subject, const protocol::Header& header, Time now) {
  const std::uint32_t next = subject.window.newest() + 1;
  switch (subject.window.Accept(header.session, header.sequence)) {
    case protocol::SequenceStatus::kNewest:
      if (header.sequence != next) subject.skipped_at = now;
      return true;
    case protocol::SequenceStatus::kRestart: return true;
    case protocol::SequenceStatus::kDuplicate: metrics_->Add(Counter::kPosesDuplicate); break;
    case protocol::SequenceStatus::kLate:
      // The pose that overtook this one could have waited for it.
      if (subject.reorders && now - subject.skipped_at <= kEarlierPatience) {
        subject.reorders_until = now + kReorderMemory;
      }
      metrics_->Add(Counter::kPosesLate);
      break;
    case protocol::SequenceStatus::kOldSession: metrics_->Add(Counter::kPosesLate); break;
  }
  subject.stats.OnLate();
  return false;
}

void Publishers::OnUnknownStream(Peer& peer, const protocol::Header& header, std::uint64_t hash,
                                 MessageSender& messages, Time now) {
  metrics_->Add(Counter::kPosesUnknownStream);
  // Poses of an unknown stream arrive at the frame rate; a reply to each would amplify the traffic.
  if (!peer.skeleton_requests.Allow(header.session, header.stream, now)) return;
  metrics_->Add(Counter::kSkeletonsRequested);
  messages.SendReply(peer, MessageSender::ReplyHeader(header),
                     protocol::SkeletonReply{hash, protocol::SkeletonStatus::kNeeded, {}});
}

void Publishers::OnGoodbye(const Peer& peer, const protocol::Header& header, Time now) {
  Subject* subject = subjects_->Find(StreamKey{peer.id, header.session, header.stream});
  if (subject == nullptr) return;
  spdlog::info("subject '{}' ended its stream", subject->name);
  subject->ended = true;
  // Decay() gets the time since the last update, which counts from the goodbye.
  subject->last_update = now;
}

void Publishers::EndForbidden(const Peer& peer, Time now) {
  for (const auto& subject : subjects_->all()) {
    if (subject->owner.peer != peer.id || peer.access.MayPublish(subject->name)) continue;
    metrics_->Add(Counter::kRefusedPublish);
    spdlog::info("subject '{}' ends: {}", subject->name, peer.access.Text());
    subject->ended = true;
    subject->last_update = now;
    subjects_->Release(*subject);
  }
}

Publishers::Change Publishers::AgeSubject(Subject& subject, Time now) {
  const Time silence = now - std::max(subject.last_pose, awake_since_);
  // Also ends a subject that never sent a pose. One without a face is still there.
  const Time heard = std::max({subject.last_pose, subject.last_no_face, awake_since_});
  if (now - heard > FromSeconds(limits_.idle_seconds)) return Change::kGone;
  if (subject.no_face && now - subject.last_no_face >= FromSeconds(limits_.loss_seconds)) {
    subject.no_face = subject.lost = false;  // now it is lost, which is reported below
  }
  SubjectPipeline& pipeline = *subject.pipeline;
  if (!pipeline.has_pose()) return subject.ended ? Change::kGone : Change::kNone;
  if (!subject.ended && silence < FromSeconds(limits_.loss_seconds)) return Change::kNone;
  if (!subject.lost && !subject.ended && !subject.no_face) {
    spdlog::warn("subject '{}' stopped sending and decays to neutral", subject.name);
    metrics_->Add(Counter::kSubjectsLost);
  }
  subject.lost = true;
  // A lost subject stays until idle_seconds, because its sender may return. One that said goodbye
  // leaves as soon as nothing is visible of it.
  if (pipeline.neutral()) return subject.ended ? Change::kGone : Change::kNone;
  // The decay goes on from where it was before a stall, so that weights do not jump.
  const Time step = now - std::max(subject.last_update, awake_since_);
  if (step < kDecayInterval) return Change::kNone;
  const bool decayed = pipeline.Decay(ToSeconds(step)) == wrinkle::JobStatus::kOk;
  subject.last_update = now;
  return decayed ? Change::kDecayed : Change::kNone;
}

}  // namespace furrow::server
