// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/subjects/subject_registry.h"

namespace furrow::server {

// Where what happens is told to whoever records it. Called on the network threads, of different
// subjects at once, but for offers and departures, which come from one that is alone in the hub:
// must neither block nor allocate in the long run. Nothing is told that the daemon did not use.
class RecordingTap {
 public:
  virtual ~RecordingTap() = default;

  // An offer was accepted; also when the same is offered again.
  virtual void OnOffer(const Subject& subject, const protocol::SkeletonOffer& offer, Time now) = 0;
  // The subject has a new pose. `payload`: the FlatBuffers buffer that it came as; empty where it
  // does not say the whole pose (a partial one, a foreign wire): subject.pipeline has it.
  virtual void OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time now) = 0;
  // The subject's wrinkle weights are new, or (age_us > 0) they decay.
  virtual void OnWeights(const Subject& subject, std::int64_t age_us, Time now) = 0;
  virtual void OnSubjectGone(const Subject& subject) = 0;
  // A datagram with an envelope of ours. `sender`: IPv6 address (or mapped IPv4) and port, both in
  // network order.
  virtual void OnDatagram(const std::array<std::uint8_t, 18>& sender,
                          std::span<const std::uint8_t> bytes, Time now) = 0;
};

}  // namespace furrow::server
