// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/jitter/jitter_buffers.h"
#include "server/session/peers/peer_table.h"
#include "server/session/subjects/pose_batch.h"

namespace furrow::server {

// An interface of senders that collect messages, so that one system call sends many of them.
// Flush() sends the collected messages.
class BufferedSender {
 public:
  virtual ~BufferedSender() = default;
  virtual void Flush() = 0;
};

// The part of the hub that belongs to one network thread: the peers whose messages arrive on its
// sockets, and everything that a pose needs on its way. Other threads access it only while they
// hold the exclusive lock (Shards::ExclusiveLock).
struct Shard {
  Shard(int number, int num_shards, std::uint64_t session, Metrics* metrics)
      : index(number), peers(number, num_shards), context(session, metrics, number) {}

  const int index;
  PeerTable peers;
  JitterBuffers held;  // poses that wait for their time
  PoseBatch gathered;  // poses accepted but not solved yet
  PublishContext context;
  // The poses whose weights wait in `buffered_sender`.
  struct Published {
    Time received{0};          // or released from a jitter buffer
    std::optional<Time> late;  // beyond the fastest poses of the stream; absent: no capture time
  };
  std::vector<Published> published;
  BufferedSender* buffered_sender = nullptr;  // null: messages leave at once
  // The pose that PoseTracer follows is in `gathered`, or in `buffered_sender`.
  enum class Followed : std::uint8_t { kNone, kGathered, kPublished };
  Followed followed = Followed::kNone;
  // Nesting depth of the locks that the shard's thread holds.
  int shard_locks = 0;
  int exclusive_locks = 0;

  // Decoded messages. Reusing their memory keeps the packet path free of allocations.
  struct Incoming {
    protocol::Hello hello;
    protocol::Ping ping;
    protocol::Pong pong;
    protocol::Goodbye goodbye;
    protocol::SkeletonOffer offer;
    protocol::PoseFrame pose;
    protocol::PoseFrame previous;  // that `pose` repeats
    protocol::SubscribeWeights subscribe_weights;
    protocol::SubscribePictures subscribe_pictures;
    protocol::SubscribePoses subscribe_poses;
    protocol::UpdatePictures update_pictures;
    protocol::FrameAck frame_ack;
    protocol::Unsubscribe unsubscribe;
    protocol::ListSubjects list_subjects;
    protocol::SubjectState subject_state;
    protocol::Drain drain;
  } in;
};

}  // namespace furrow::server
