// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "protocol/messages/messages.h"
#include "server/core/metrics.h"
#include "server/session/delivery/desk.h"
#include "server/session/peers/peer_table.h"
#include "server/session/subjects/pose_batch.h"

namespace furrow::server {

// What a lane's thread has for its peers and has not sent yet; what leaves together is cheaper.
class Outlet {
 public:
  virtual ~Outlet() = default;
  virtual void Flush() = 0;
};

// What one network thread has of a hub for itself: those whose messages come over its sockets, and
// all that a pose needs on its way. Other threads reach in only while they are alone in the hub.
struct Lane {
  Lane(int number, int lanes, std::uint64_t session, Metrics* metrics)
      : index(number), peers(number, lanes), desk(session, metrics, number) {}

  const int index;
  PeerTable peers;
  PoseBatch gathered;
  Desk desk;
  Outlet* outlet = nullptr;
  // Of the lane's thread, nested: how many turns, and how often alone.
  int turns = 0;
  int alone = 0;

  // Decoded into again and again, so that the packet path does not allocate.
  struct Incoming {
    protocol::Hello hello;
    protocol::Ping ping;
    protocol::Pong pong;
    protocol::Goodbye goodbye;
    protocol::SkeletonOffer offer;
    protocol::PoseFrame pose;
    protocol::SubscribeWeights subscribe_weights;
    protocol::SubscribePictures subscribe_pictures;
    protocol::SubscribePoses subscribe_poses;
    protocol::UpdatePictures update_pictures;
    protocol::FrameAck frame_ack;
    protocol::Unsubscribe unsubscribe;
    protocol::ListSubjects list_subjects;
  } in;
};

}  // namespace furrow::server
