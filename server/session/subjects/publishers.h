// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/codec/codec.h"
#include "protocol/messages/messages.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/delivery/message_sender.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/arrivals.h"
#include "server/session/subjects/jitter_delays.h"
#include "server/session/subjects/places.h"
#include "server/session/subjects/pose_batch.h"
#include "server/session/subjects/subject_registry.h"
#include "server/shares/host_rates.h"

namespace furrow::server {

// How long a pose waits for earlier ones in a stream in which datagrams overtake each other.
// Networks that reorder deliver the earlier datagram soon after the later one, or after a time that
// is not worth waiting for.
inline constexpr Time kEarlierPatience = std::chrono::milliseconds(2);
// For this long after such a case, the poses of the stream wait.
inline constexpr Time kReorderMemory = std::chrono::seconds(5);

// The publishing half of a session: offers become subjects, poses become wrinkle weights, and
// silent subjects decay (STANDARD.md sections 6 and 7). Knows no subscribers; the caller passes
// results on.
//
// A pose takes three steps, so that many are solved together between the second and the third:
// FindSubject(), AcceptPose(), OnSolved(). These and OnUnknownStream() run under a shard's lock;
// all other functions require the exclusive lock.
class Publishers {
 public:
  // `random`: returns unpredictable numbers, never 0.
  Publishers(const Limits& limits, JitterDelays delays, StreamDefinitions* definitions,
             SubjectRegistry* subjects, MessageSender* messages, Places* places, Arrivals* arrivals,
             std::function<std::uint64_t()> random, Metrics* metrics);

  // Limits new skeletons of all senders together, because binding one takes milliseconds. One host
  // gets half of it, so that a flood of offers leaves room for the others.
  static constexpr double kNewSkeletonsPerSecond = 20.0;
  static constexpr double kNewSkeletonsBurst = 256.0;
  static constexpr double kShareOfHost = 0.5;
  // Hosts that offer little get these in addition, so that a few hosts that flood shut nobody out.
  static constexpr double kReservedPerSecond = 10.0;
  static constexpr std::uint32_t kReservedPerHost = 1;  // per second

  // Replies to the offer, unless it has to wait for a place; senders then repeat it. Returns the
  // subject that was started or changed; null if the offer was refused or not answered.
  Subject* OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
                   Time now);
  // Goes on with a subject of the daemon that was here before, as if `peer` had sent the offer. No
  // replies. Null: there is such a subject, it is not permitted, or there is no room.
  [[nodiscard]] Subject* Resume(Peer& peer, const protocol::Header& header,
                                const protocol::SkeletonOffer& offer,
                                const Arrivals::Arrived& arrived, Time now);
  // The subject of the pose; null if no accepted offer matches (see OnUnknownStream()).
  [[nodiscard]] Subject* FindSubject(const Peer& peer, const protocol::Header& header,
                                     const protocol::PoseFrame& pose);
  // Copies the pose into the subject's pipeline. False: the pose was dropped and counted, because
  // it is late, duplicate or does not fit the skeleton.
  [[nodiscard]] bool AcceptPose(Subject& subject, const protocol::Header& header,
                                const protocol::PoseFrame& pose, Time now);
  // Counts a pose that was taken from the next one.
  void OnRecovered();
  // Counts a pose that waits already.
  void OnDuplicate(Subject& subject);
  // Counts a pose that waits. `full`: another one left early.
  void OnHeld(bool full);
  // Completes a solved pose. False: the solver rejected the pose, which is counted.
  [[nodiscard]] bool OnSolved(const GatheredPose& pose);
  // Records that a stream arrives without a face. Its subject decays as if it were silent, but
  // stays and is not reported as lost. Requires the lock of the stream's shard.
  void OnNoFace(const Peer& peer, const protocol::Header& header, Time now);
  // Asks the sender of a pose for its skeleton. Replies at most once per stream and interval.
  void OnUnknownStream(Peer& peer, const protocol::Header& header, std::uint64_t skeleton_hash,
                       MessageSender& messages, Time now);
  // Lets the stream's subject, if it has one, decay and leave.
  void OnGoodbye(const Peer& peer, const protocol::Header& header, Time now);

  // Ends the peer's subjects that its access does not allow (any more).
  void EndForbidden(const Peer& peer, Time now);

  // The place of a subject in a cluster, which the hub asks for every Places::kRefresh. kElsewhere:
  // the publisher has been sent there. `owner`: the peer that publishes it; null: it has left.
  [[nodiscard]] Place RenewPlace(Subject& subject, Peer* owner, Time now);
  // Asks the publishers for their offers again that wait for places which are here now. With many,
  // some of them at each call.
  // `find_peer`: null if the peer has left.
  void AskAgain(const std::function<Peer*(PeerId)>& find_peer, Time now);
  // Sends the publisher of the subject to the node. `owner`: as for RenewPlace().
  void SendAway(const Subject& subject, Peer* owner, const NodeAddress& node);

  // The daemon runs again after a stall that ended at `now`. Nobody could be heard during it, so
  // silence counts from here: the poses of the stall still wait in the sockets.
  void OnStall(Time now) { awake_since_ = now; }

  enum class Change { kNone, kDecayed, kGone };
  // Decays a subject without poses. kDecayed: its weights have changed. kGone: its publisher
  // has left and it is neutral, or it has been idle for Limits::idle_seconds; the caller notifies
  // subscribers and removes it from the registry.
  Change AgeSubject(Subject& subject, Time now);

 private:
  void GoOn(const Arrivals::Arrived& arrived, Subject* subject, Time now);
  Subject* Accept(Peer& peer, const StreamKey& key, const protocol::SkeletonOffer& offer,
                  std::shared_ptr<const StreamDefinition> stream, Time now);
  [[nodiscard]] std::shared_ptr<const StreamDefinition> DefinitionFor(
      Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer, Time now);
  [[nodiscard]] std::optional<Place> TakePlace(Peer& peer, const protocol::Header& header,
                                               const protocol::SkeletonOffer& offer, Time now);
  void Contest(Peer& peer, const protocol::Header& header, const std::string& subject);
  void Reject(Peer& peer, const protocol::Header& header, std::uint64_t hash, std::string why,
              Time now);
  [[nodiscard]] bool IsContested(const Subject& subject, const Peer& peer, const StreamKey& key,
                                 Time now) const;
  bool TakeNewSkeleton(const std::string& host, Time now);
  bool IsNew(Subject& subject, const protocol::Header& header, Time now);
  std::shared_ptr<const protocol::SkeletonOffer> ShareOffer(const protocol::SkeletonOffer& offer);

  const Limits& limits_;  // of the hub, which may change them
  const JitterDelays delays_;
  StreamDefinitions* const definitions_;
  SubjectRegistry* const subjects_;
  MessageSender* const messages_;
  Places* const places_;
  Arrivals* const arrivals_;
  const std::function<std::uint64_t()> random_;
  Metrics* const metrics_;
  // By skeleton hash. Entries of offers that no subject uses expire.
  std::map<std::uint64_t, std::weak_ptr<const protocol::SkeletonOffer>> offers_;
  std::map<std::string, TokenBucket, std::less<>> new_skeletons_of_;  // by host
  TokenBucket new_skeletons_{kNewSkeletonsPerSecond, kNewSkeletonsBurst};
  HostRates reserved_of_{kReservedPerHost};
  TokenBucket reserved_{kReservedPerSecond, kReservedPerSecond};
  std::string asked_again_;            // the subject that AskAgain() looked at last
  Time awake_since_{0};                // end of the last stall
  TokenBucket log_bucket_{2.0, 20.0};  // repeated bad offers must not flood the log
};

}  // namespace furrow::server
