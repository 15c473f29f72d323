// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// The interface of a recorder: receives the skeletons, poses, weights and datagrams that the hub
// uses. Several network threads call it at once, for different subjects; OnOffer(),
// OnSubjectGone() and OnRig() are called under the exclusive lock. Implementations must not block,
// and must not allocate in the long run. Dropped messages are not reported.
class RecordingTap {
 public:
  virtual ~RecordingTap() = default;

  // An offer was accepted; it may equal the subject's previous offer.
  virtual void OnOffer(const Subject& subject, const protocol::SkeletonOffer& offer, Time now) = 0;
  // The subject has a new pose. `payload`: the FlatBuffers buffer in which it arrived, valid during
  // the call; empty for a partial pose or a foreign protocol. subject.pipeline has the whole pose.
  virtual void OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time now) = 0;
  // The subject has new wrinkle weights. `age_us` > 0: without a new pose, as when they decay.
  virtual void OnWeights(const Subject& subject, std::int64_t age_us, Time now) = 0;
  // The subject is about to be removed.
  virtual void OnSubjectGone(const Subject& subject) = 0;
  // The weights of all subjects are those of another rig from now on.
  virtual void OnRig(const wrinkle::Rig& rig, const SubjectRegistry& subjects, Time now) = 0;
  // A datagram with a valid envelope has arrived. `sender`: IPv6 address (or mapped IPv4) and port,
  // both in network byte order.
  virtual void OnDatagram(const std::array<std::uint8_t, 18>& sender,
                          std::span<const std::uint8_t> bytes, Time now) = 0;
};

}  // namespace furrow::server
