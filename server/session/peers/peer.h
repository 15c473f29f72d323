// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/core/token_bucket.h"
#include "server/session/peers/send_credit.h"
#include "server/session/peers/stray_limiter.h"

namespace furrow::server {

using PeerId = std::uint64_t;  // never used twice in a run; 0 is nobody

// As SendFrame()'s `keep`: frames wait in line with the answers, and where there is no more room
// the new one is left out. For those who want every frame.
inline constexpr std::size_t kKeepAll = std::numeric_limits<std::size_t>::max();

enum class Transport { kTcp, kUdp, kMocap, kWeb };

// How bytes get to a peer. The net side implements it; tests do with a few lines.
//
// Called by a thread that is alone in the hub; frames also by one that publishes in its own lane,
// while others do in theirs.
class Link {
 public:
  virtual ~Link() = default;
  // Answers: in order, never replaced by anything newer.
  virtual void SendReply(std::span<const std::uint8_t> message) = 0;
  // Weights, poses and pictures: where the peer is slow, the newest `keep` of a key win. Returns
  // how many frames were dropped. `lane`: of the thread that calls; kAlone: it is alone in the hub,
  // and frames go the way of the answers, so that none overtakes the one that explains it.
  static constexpr int kAlone = -1;
  virtual int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                        int lane) = 0;
  // Whether the peer takes several messages in a datagram; for links that have such.
  virtual void TakesBundles(bool /*takes*/) {}
  // The frames of a key are no longer wanted.
  virtual void DropFrames(std::uint64_t key) = 0;
  // The peer has not taken a byte for a while: what it is sent would only push out what waits.
  [[nodiscard]] virtual bool IsStuck(Time /*now*/) const { return false; }
};

// Somebody at the other end of a connection or a UDP address.
struct Peer {
  PeerId id = 0;
  Transport transport = Transport::kTcp;
  std::string name;  // "udp 127.0.0.1:50112", for the log
  Link* link = nullptr;
  TokenBucket bucket{1.0, 1.0};
  SendCredit credit;        // UDP: how much may be sent before the address is proven
  std::uint64_t token = 0;  // UDP: what Hello must bring back
  Time last_heard{0};
  StrayLimiter strays;  // poses without an offer
  int num_subscriptions = 0;
  bool stuck = false;                            // its link was, at the last tick
  bool publishes = false;                        // had an offer accepted
  std::uint16_t last_subscription = 0;           // the id given out last
  std::optional<protocol::Header> follows_list;  // the request to be told who comes and goes
  std::uint64_t listed = 0;                      // the registry's version that it was told last
};

}  // namespace furrow::server
