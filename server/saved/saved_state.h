// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/secure/session/session_state.h"
#include "server/core/time.h"

namespace furrow::server {

// What a daemon leaves to the one that takes its place on the same machine: sessions, subjects and
// subscriptions, so that clients notice nothing of a restart. Times are of the steady clock, which
// both share. Requests and subjects are messages of the wire, so the new daemon checks them like
// any other message.

using SavedMessage = std::vector<std::uint8_t>;

// A subscription, as the request for it. `id`: the number that the client knows.
struct SavedSubscription {
  std::uint16_t id = 0;
  SavedMessage request;
};

// What a token has granted to a peer that has shown it.
struct SavedAccess {
  protocol::secure::Grant grant;
  std::uint32_t key_id = 0;
  Time expires{0};
};

// A peer of the hub, without its socket.
struct SavedPeer {
  std::uint64_t id = 0;  // its number at the former daemon
  Time consent{0};       // when it last agreed to get what it is sent
  Time last_heard{0};
  std::uint16_t last_subscription = 0;
  bool follows_list = false;  // of subjects, by the request with this sequence
  std::uint32_t list_sequence = 0;
  std::optional<SavedAccess> access;  // none: that of its session, or of everybody
  std::vector<SavedSubscription> subscriptions;
};

// A plain UDP address, or a secure session.
struct SavedUdpPeer {
  std::uint8_t shard = 0;
  std::array<std::uint8_t, 18> address{};  // UdpAddress; of a secure session, the first one
  std::uint32_t scope = 0;                 // of a link-local address
  bool is_v4 = false;
  std::uint64_t session = 0;
  std::uint32_t secure_session = 0;  // 0: plain
  std::uint32_t next_message = 0;
  bool takes_bundles = false;
  SavedPeer peer;
};

// A plain TCP connection.
struct SavedConnection {
  std::uint64_t socket = 0;          // SocketCookie()
  std::vector<std::uint8_t> input;   // of a frame that has not arrived whole
  std::vector<std::uint8_t> output;  // not sent yet
  SavedPeer peer;
};

struct SavedSecureSession {
  std::uint8_t shard = 0;
  bool is_v4 = false;
  std::uint32_t scope = 0;
  protocol::secure::SessionState session;
};

struct SavedSubject {
  std::uint64_t owner = 0;  // SavedPeer::id of its publisher
  std::string host;         // of its publisher
  Time last_pose{0};
  Time last_update{0};
  Time last_no_face{0};
  bool no_face = false;
  bool ended = false;
  bool lost = false;
  bool needs_all_drivers = false;
  SavedMessage offer;  // SkeletonOffer with the number of the publisher's stream
  SavedMessage state;  // SubjectState
};

struct SavedState {
  Time saved{0};  // the former daemon has done nothing since then
  std::uint64_t session = 0;
  std::vector<std::uint64_t> udp_sockets;  // SocketCookie(), by shard
  std::vector<SavedUdpPeer> udp;
  std::vector<SavedConnection> connections;
  std::vector<SavedSecureSession> secure;
  std::vector<SavedSubject> subjects;  // in the order of their arrival
};

}  // namespace furrow::server
