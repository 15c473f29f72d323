// SPDX-License-Identifier: Apache-2.0
#include "server/session/stream_router.h"

namespace furrow::server {

// Requires the exclusive lock: an offer adds or rebinds a subject.
bool StreamRouter::OnOffer(Peer& peer, const protocol::Header& header,
                           const protocol::SkeletonOffer& offer, Time now) {
  // Subscribers learn of a new skeleton before the first pose that uses it, and so does the
  // recording.
  Subject* subject = parts_.publishers->OnOffer(peer, header, offer, now);
  if (subject == nullptr) return false;
  parts_.subscribers->OnSubjectReady(*subject);
  if (parts_.recording != nullptr) parts_.recording->OnOffer(*subject, offer, now);
  return true;
}

void StreamRouter::AcceptPose(Shard& shard, Peer& peer, const protocol::Header& header,
                              const protocol::PoseFrame& pose,
                              std::span<const std::uint8_t> payload, Time now) {
  Publishers& publishers = *parts_.publishers;
  Subject* subject = publishers.FindSubject(peer, header, pose);
  // A batch must not be observable. An answer to a pose follows the poses before it, and the next
  // pose of a subject builds on the last one.
  const bool can_wait = subject != nullptr && !subject->pipeline->waits() && !shard.gathered.full();
  // `waits` is true if a pose of this subject is already in the batch.
  if (!can_wait) PublishGathered(shard);
  if (subject == nullptr) {
    publishers.OnUnknownStream(peer, header, pose.skeleton_hash, shard.context.messages, now);
  } else if (publishers.AcceptPose(*subject, header, pose)) {
    shard.gathered.Add({.subject = subject, .header = header, .payload = payload, .now = now});
  }
}

// Solves together, then publishes in the order of arrival. So output does not depend on how many
// poses a batch holds.
void StreamRouter::PublishGathered(Shard& shard) {
  if (shard.gathered.empty()) return;
  for (const GatheredPose& pose : shard.gathered.Solve()) {
    if (!parts_.publishers->OnSolved(pose)) continue;
    // The recording receives a pose before the weights that it caused.
    if (parts_.recording != nullptr) {
      parts_.recording->OnPose(*pose.subject, pose.payload, pose.now);
    }
    Publish(shard, *pose.subject, pose.payload, /*age_us=*/0, pose.now);
  }
}

void StreamRouter::PublishAged(Shard& shard, Subject& subject, std::int64_t age_us, Time now) {
  Publish(shard, subject, {}, age_us, now);
}

void StreamRouter::Publish(Shard& shard, Subject& subject, std::span<const std::uint8_t> payload,
                           std::int64_t age_us, Time now) {
  if (fans_out_) {
    // Under the exclusive lock, frames take the way of the replies and cannot overtake them.
    PublishContext* context = shard.exclusive_locks > 0 ? parts_.exclusive_context : &shard.context;
    parts_.subscribers->fan_out().Publish(subject, payload, age_us, now, context);
  }
  // OSC output and the recording continue while the daemon drains; only peers stop receiving
  // frames.
  if (on_weights_) on_weights_(subject, shard.index, now);
  if (parts_.recording != nullptr) parts_.recording->OnWeights(subject, age_us, now);
}

}  // namespace furrow::server
