// SPDX-License-Identifier: Apache-2.0
#include "server/session/stream_router.h"

#include <cstddef>
#include <optional>

#include "protocol/framing/sequence.h"

namespace furrow::server {
namespace {

// How much later than the fastest poses of its stream a pose arrived. Absent: it has no capture
// time.
std::optional<Time> LateOf(Subject& subject, std::int64_t captured_us, Time now) {
  if (captured_us == 0) return std::nullopt;
  return now - subject.capture_clock.Arrival(captured_us, now);
}

}  // namespace

// Requires the exclusive lock: an offer adds or rebinds a subject.
bool StreamRouter::OnOffer(Peer& peer, const protocol::Header& header,
                           const protocol::SkeletonOffer& offer, Time now) {
  // Subscribers learn of a new skeleton before the first pose that uses it, and so does the
  // recording.
  const Subject* const known = parts_.subjects->Find(offer.subject);
  const std::uint64_t epoch = known == nullptr ? 0 : known->epoch;
  Subject* subject = parts_.publishers->OnOffer(peer, header, offer, now);
  if (subject == nullptr) return false;
  parts_.subscribers->OnSubjectReady(*subject);
  if (known != nullptr && subject->epoch != epoch) parts_.subscribers->OnEpoch(*subject);
  if (parts_.recording != nullptr) parts_.recording->OnOffer(*subject, offer, now);
  return true;
}

Subject* StreamRouter::Resume(Peer& peer, const protocol::Header& header,
                              const protocol::SkeletonOffer& offer,
                              const Arrivals::Arrived& arrived, Time now) {
  Subject* const subject = parts_.publishers->Resume(peer, header, offer, arrived, now);
  if (subject != nullptr && parts_.recording != nullptr) {
    parts_.recording->OnOffer(*subject, offer, now);
  }
  return subject;
}

void StreamRouter::Prefetch(const Peer& peer, const protocol::Header& header) {
  const Subject* subject = parts_.subjects->Find(StreamKey{peer.id, header.session, header.stream});
  if (subject != nullptr) subject->pipeline->Prefetch();
}

void StreamRouter::AcceptPose(Shard& shard, Peer& peer, const protocol::Header& header,
                              const protocol::PoseFrame& pose,
                              std::span<const std::uint8_t> payload, Time now) {
  Publishers& publishers = *parts_.publishers;
  Subject* subject = publishers.FindSubject(peer, header, pose);
  if (subject == nullptr) {
    // A batch must not be observable: an answer to a pose follows the poses before it.
    PublishGathered(shard);
    publishers.OnUnknownStream(peer, header, pose.skeleton_hash, shard.context.messages, now);
    return;
  }
  peer.last_used = now;
  HoldOrUse(shard, *subject, header, pose, payload, now);
}

bool StreamRouter::MissesPrevious(Shard& shard, const Peer& peer, const protocol::Header& header) {
  const StreamKey stream{peer.id, header.session, header.stream};
  const Subject* subject = parts_.subjects->Find(stream);
  if (subject == nullptr) return false;
  const std::uint32_t sequence = header.sequence - 1;
  const protocol::SequenceWindow& window = subject->window;
  const bool follows = window.started() && window.session() == header.session;
  if (follows && !protocol::IsNewer(sequence, window.newest())) return false;
  return shard.held.Misses(stream, sequence);
}

void StreamRouter::AcceptPrevious(Shard& shard, const Peer& peer, protocol::Header header,
                                  std::uint32_t age_us, const protocol::PoseFrame& previous,
                                  Time now) {
  Subject* subject = parts_.subjects->Find(StreamKey{peer.id, header.session, header.stream});
  if (subject == nullptr || subject->skeleton_hash != previous.skeleton_hash) return;
  parts_.publishers->OnRecovered();
  header.sequence -= 1;
  if (header.capture_time_us != 0) header.capture_time_us -= age_us;
  // Relayed and recorded like a pose of a foreign wire: its bytes end with those of the other pose.
  HoldOrUse(shard, *subject, header, previous, {}, now);
}

void StreamRouter::HoldOrUse(Shard& shard, Subject& subject, const protocol::Header& header,
                             const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload,
                             Time now) {
  if (subject.hold != Time{0}) {
    if (!Hold(shard, subject, header, pose, payload, now)) {
      Use(shard, subject, header, pose, payload, now);
    }
  } else if (IsAhead(shard, subject, header, now)) {
    CountHeld(subject,
              shard.held.AddAhead(subject.owner, header, pose, payload, kEarlierPatience, now));
  } else {
    Use(shard, subject, header, pose, payload, now);
    if (!shard.held.WaitsAhead(subject.owner)) return;
    subject.reorders_until = now + kReorderMemory;  // the wait was worth while
    UseReleased(shard, shard.held.TakeFollowing(subject.owner, subject.window.newest()), now);
  }
}

// True if the pose waits for an earlier one. Only streams wait in which poses have overtaken each
// other lately, so that loss alone, or a sender that leaves out numbers, costs no time.
bool StreamRouter::IsAhead(Shard& shard, const Subject& subject, const protocol::Header& header,
                           Time now) {
  const protocol::SequenceWindow& window = subject.window;
  if (now >= subject.reorders_until && !shard.held.WaitsAhead(subject.owner)) return false;
  if (subject.ended || !window.started() || window.session() != header.session) return false;
  return protocol::IsNewer(header.sequence, window.newest() + 1);
}

// Puts a pose into the jitter buffer. False: it is too late for that.
bool StreamRouter::Hold(Shard& shard, Subject& subject, const protocol::Header& header,
                        const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload,
                        Time now) {
  const auto place = shard.held.Add(subject.owner, header, pose, payload, subject.hold, now);
  CountHeld(subject, place);
  return place != JitterBuffers::Place::kLate;
}

void StreamRouter::CountHeld(Subject& subject, JitterBuffers::Place place) {
  switch (place) {
    case JitterBuffers::Place::kLate: break;  // it is used, which counts it
    case JitterBuffers::Place::kDuplicate: parts_.publishers->OnDuplicate(subject); break;
    case JitterBuffers::Place::kFull: parts_.publishers->OnHeld(/*full=*/true); break;
    case JitterBuffers::Place::kHeld: parts_.publishers->OnHeld(/*full=*/false); break;
  }
}

void StreamRouter::Use(Shard& shard, Subject& subject, const protocol::Header& header,
                       const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload,
                       Time now) {
  // The next pose of a subject builds on the last one. `waits` is true if a pose of this subject is
  // already in the batch.
  if (subject.pipeline->waits() || shard.gathered.full()) PublishGathered(shard);
  if (parts_.publishers->AcceptPose(subject, header, pose, now)) {
    shard.gathered.Add({.subject = &subject,
                        .header = header,
                        .timecode = pose.timecode,
                        .payload = payload,
                        .now = now});
    if (parts_.tracer != nullptr && parts_.tracer->Wants(subject.id)) {
      BeginTrace(shard, subject, header, now);
    }
  }
}

void StreamRouter::BeginTrace(Shard& shard, Subject& subject, const protocol::Header& header,
                              Time now) {
  shard.followed = Shard::Followed::kGathered;
  parts_.tracer->OnAccepted({.sequence = header.sequence,
                             .late = LateOf(subject, header.capture_time_us, now),
                             .buffered = subject.hold,
                             .received = now});
}

void StreamRouter::ReleaseHeld(Shard& shard, Time now) {
  UseReleased(shard, shard.held.TakeDue(now), now);
}

void StreamRouter::ReleaseStream(Shard& shard, const StreamKey& stream, Time now) {
  UseReleased(shard, shard.held.TakeAll(stream), now);
}

void StreamRouter::UseReleased(Shard& shard, std::span<const JitterBuffers::Released> released,
                               Time now) {
  if (released.empty()) return;
  for (const auto& [stream, held] : released) {
    // The subject may have left, changed hands or got another skeleton meanwhile.
    Subject* subject = parts_.subjects->Find(stream);
    if (subject == nullptr || subject->skeleton_hash != held->pose.skeleton_hash) continue;
    Use(shard, *subject, held->header, held->pose, held->payload, now);
  }
  PublishGathered(shard);  // which reads the payloads
  shard.held.Recycle();
}

// The solver has refused the pose that was followed. The next one is followed instead.
void StreamRouter::RetryTrace(Shard& shard) {
  shard.followed = Shard::Followed::kNone;
  parts_.tracer->OnRefused();
}

void StreamRouter::EndTrace(Shard& shard) {
  shard.followed = Shard::Followed::kNone;
  parts_.tracer->OnSent();
}

// Solves together, then publishes in the order of arrival. So output does not depend on how many
// poses a batch holds.
void StreamRouter::PublishGathered(Shard& shard) {
  if (shard.gathered.empty()) return;
  PoseTracer* const tracer = shard.followed == Shard::Followed::kGathered ? parts_.tracer : nullptr;
  if (tracer != nullptr) tracer->OnSolving(shard.gathered.size());
  const std::span<const GatheredPose> poses = shard.gathered.Solve();
  if (tracer != nullptr) tracer->OnSolved();
  for (const GatheredPose& pose : poses) {
    const bool is_followed = tracer != nullptr && tracer->Follows(pose.subject->id);
    if (!parts_.publishers->OnSolved(pose)) {
      if (is_followed) RetryTrace(shard);
      continue;
    }
    // The recording receives a pose before the weights that it caused.
    if (parts_.recording != nullptr) {
      parts_.recording->OnPose(*pose.subject, pose.payload, pose.now);
    }
    Publish(shard, *pose.subject, pose.payload, /*age_us=*/0, pose.now);
    NotePublished(shard, pose);
    if (is_followed) {
      tracer->OnPublished();
      shard.followed = Shard::Followed::kPublished;
    }
  }
}

// For the histograms of latency, when the weights leave.
void StreamRouter::NotePublished(Shard& shard, const GatheredPose& pose) {
  // Far above what one flush sends.
  constexpr std::size_t kMost = 16 * PoseBatch::kCapacity;
  if (shard.buffered_sender == nullptr || shard.published.size() == kMost) return;
  shard.published.push_back(
      {pose.now, LateOf(*pose.subject, pose.header.capture_time_us, pose.now)});
}

void StreamRouter::PublishAged(Shard& shard, Subject& subject, std::int64_t age_us, Time now) {
  Publish(shard, subject, {}, age_us, now);
}

void StreamRouter::Publish(Shard& shard, Subject& subject, std::span<const std::uint8_t> payload,
                           std::int64_t age_us, Time now) {
  if (now >= subject.served_until) return;  // another node may serve it, also while it decays
  if (fans_out_) {
    // Under the exclusive lock, of whichever shard, frames take the way of the replies and cannot
    // overtake them.
    PublishContext* context = exclusive_ ? parts_.exclusive_context : &shard.context;
    parts_.subscribers->fan_out().Publish(subject, payload, age_us, now, context);
  }
  // OSC output and the recording continue while the daemon drains; only peers stop receiving
  // frames.
  if (on_weights_) on_weights_(subject, shard.index, now);
  if (parts_.recording != nullptr) parts_.recording->OnWeights(subject, age_us, now);
}

}  // namespace furrow::server
