// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "protocol/codec/codec.h"
#include "protocol/messages/messages.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/delivery/postman.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/pose_batch.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// The publishing half of a daemon: offers become subjects, poses become wrinkle weights, whoever
// falls silent decays (STANDARD.md sections 6 and 7). Knows no subscriber: what is to be sent on is
// returned to the caller.
class Publishers {
 public:
  Publishers(const Limits& limits, StreamDefinitions* definitions, SubjectRegistry* subjects,
             Postman* postman, Metrics* metrics);

  // Skeletons that nobody offered before, of all senders together: to bind one takes milliseconds.
  static constexpr double kNewSkeletonsPerSecond = 20.0;
  static constexpr double kNewSkeletonsBurst = 256.0;

  // Answers the offer, but where new skeletons come too fast: senders offer again. The subject that
  // it starts or changes; null where nothing changed.
  Subject* OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
                   Time now);
  // A pose in three steps, so that many are evaluated together before the last.
  // First: the subject that it is of; null where no offer explains it, see OnStray().
  [[nodiscard]] Subject* Find(const Peer& peer, const protocol::Header& header,
                              const protocol::PoseFrame& pose);
  // Then: fills the subject's pose. False where it is too late or does not fit: dropped, counted.
  [[nodiscard]] bool Take(Subject& subject, const protocol::Header& header,
                          const protocol::PoseFrame& pose);
  // Last, after its evaluation. True: the subject's weights are new. False: dropped, counted.
  [[nodiscard]] bool OnSolved(const GatheredPose& pose);
  // Poses that no offer explains: the sender is asked for its skeleton, or, where another has taken
  // its subject over, told so; each stream at most once an interval.
  void OnStray(Peer& peer, const protocol::Header& header, std::uint64_t skeleton_hash,
               Postman& postman, Time now);
  // The subject that the stream feeds, if any, decays and then leaves.
  void OnGoodbye(const Peer& peer, const protocol::Header& header, Time now);

  enum class Change { kNone, kDecayed, kGone };
  // Holds and decays a subject that gets no poses. kDecayed: its weights changed. kGone: nothing is
  // left of it; the caller tells its subscribers and removes it from the registry.
  Change Age(Subject& subject, Time now);

 private:
  Subject* Accept(Peer& peer, const StreamKey& key, const protocol::SkeletonOffer& offer,
                  std::shared_ptr<const StreamDefinition> stream, Time now);
  void Reject(Peer& peer, const protocol::Header& header, std::uint64_t hash, std::string why,
              Time now);
  bool IsNew(Subject& subject, const protocol::Header& header);
  std::shared_ptr<const protocol::SkeletonOffer> Share(const protocol::SkeletonOffer& offer);

  const Limits limits_;
  StreamDefinitions* const definitions_;
  SubjectRegistry* const subjects_;
  Postman* const postman_;
  Metrics* const metrics_;
  // By hash, as long as a subject has them.
  std::map<std::uint64_t, std::weak_ptr<const protocol::SkeletonOffer>> offers_;
  TokenBucket new_skeletons_{kNewSkeletonsPerSecond, kNewSkeletonsBurst};
  TokenBucket log_bucket_{2.0, 20.0};  // whoever repeats a bad offer fills no disk
};

}  // namespace furrow::server
