// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "protocol/messages/messages.h"
#include "protocol/mocap/neutral_frame.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/session/peers/peer.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"

namespace furrow::server {

// Converts the frames of foreign motion-capture protocols (VMC, Live Link Face) to streams: offers
// a skeleton when a subject appears or changes its joints or blend shapes, then routes its poses.
//
// All mocap peers belong to shard 0, so shard 0's lock guards this object.
class MocapStreams {
 public:
  // A stream without poses is forgotten after `limits.idle_seconds` if its offer was rejected.
  // `limits` outlives this object.
  MocapStreams(const Limits& limits, Shards* shards, StreamRouter* router, Metrics* metrics)
      : limits_(limits), shards_(shards), router_(router), metrics_(metrics) {}

  // Handles one frame. Requires the lock of `shard`. Frames of a rejected subject, and of subjects
  // beyond the first 64, are dropped and counted as Counter::kMocapRefused.
  void OnFrame(Shard& shard, Peer& peer, const protocol::mocap::NeutralFrame& frame, Time now);

  // Records that the hub has removed a subject, so its next frame offers it again. Requires the
  // exclusive lock.
  void ForgetSubject(const std::string& name);
  // Forgets rejected streams that have gone idle. Requires the exclusive lock.
  void ForgetRejected(Time now);

 private:
  struct Stream {
    std::uint16_t number = 0;
    bool rejected = false;  // offered again every second, in case the reason has gone
    Time offered{0};
    Time last_frame{0};
    std::uint32_t layout = 0;
    protocol::SkeletonOffer offer;
  };

  [[nodiscard]] Stream* FindOrAdd(PeerId peer, const std::string& subject);
  void Offer(Shard& shard, Peer& peer, const protocol::Header& header, Stream& stream,
             const protocol::mocap::NeutralFrame& frame, Time now);

  const Limits& limits_;
  Shards* const shards_;
  StreamRouter* const router_;
  Metrics* const metrics_;
  std::map<std::pair<PeerId, std::string>, Stream> streams_;  // by peer and subject name
  std::uint16_t next_number_ = 0;
};

}  // namespace furrow::server
