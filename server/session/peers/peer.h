// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/access/access.h"
#include "server/session/peers/consent.h"
#include "server/session/peers/skeleton_request_limiter.h"
#include "server/shares/token_bucket.h"

namespace furrow::server {

using PeerId = std::uint64_t;  // unique for the life of the daemon; 0: no peer

// SendFrame()'s `keep` for subscriptions to every frame: frames queue in order with the replies,
// and if the queue is full the new frame is dropped.
inline constexpr std::size_t kKeepAll = std::numeric_limits<std::size_t>::max();

// How a peer is connected. kMocap: a foreign motion-capture protocol; kWeb: WebSocket or HTTP.
enum class Transport { kTcp, kUdp, kMocap, kWeb };

// Carries messages to one peer. The network layer implements it.
//
// The hub calls all functions under its exclusive lock. In addition, it calls SendReply() under the
// lock of the peer's shard, and SendFrame() and DropFrames() under the lock of any shard, so
// several threads may call those two at once.
class Link {
 public:
  virtual ~Link() = default;
  // Queues a reply. Replies keep their order and are never dropped for newer messages.
  virtual void SendReply(std::span<const std::uint8_t> message) = 0;
  // Queues a frame of weights, a pose or a picture. If the peer is slow, only the newest `keep`
  // frames of a `key` stay queued. Returns the number of dropped frames; kNoRoom: the new frame was
  // dropped, because there is no memory for what waits for the peer, and no other one. `shard`:
  // that of the calling thread, or kExclusive if the caller holds the exclusive lock. A kExclusive
  // frame leaves after all earlier replies, so that it cannot overtake the reply that explains it.
  static constexpr int kExclusive = -1;
  static constexpr int kNoRoom = -1;
  virtual int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                        int shard) = 0;
  // Whether the peer accepts several messages per datagram. Only UDP links use it.
  virtual void SetTakesBundles(bool /*takes_bundles*/) {}
  // Drops the queued frames of a key.
  virtual void DropFrames(std::uint64_t key) = 0;
  // Ends the connection after the replies that are queued. Only TCP has one: WebSockets end with a
  // goodbye to stream 0, and UDP peers are forgotten.
  virtual void Finish() {}
  // The same for a peer that is asked to leave: does not wait until it has read the replies.
  virtual void FinishSoon() { Finish(); }
  // The peer has shown a valid token.
  virtual void OnAdmitted() {}
  // True if the peer has stopped reading, so that new frames would only replace queued ones.
  [[nodiscard]] virtual bool IsStuck(Time /*now*/) const { return false; }
};

// The name of a peer in the log, and the host that it counts to in fair shares.
struct PeerLabel {
  PeerLabel(const char* name) : text(name) {}  // NOLINT: implicit, for peers without a host
  PeerLabel(std::string name, std::string its_host = {},
            bool is_shielded = true)  // NOLINT: implicit
      : text(std::move(name)), host(std::move(its_host)), shielded(is_shielded) {}

  std::string text;  // for the log: "udp 127.0.0.1 port 50112"
  std::string host;  // the address without the port; empty: this program itself
  // Nobody on the network can read what it sends: it is on this computer or speaks TLS.
  bool shielded = true;
  std::string address;  // numeric; empty: not known, or this program itself
};

// The other end of a connection, or a proven UDP address.
struct Peer {
  PeerId id = 0;
  Transport transport = Transport::kTcp;
  std::string name;              // PeerLabel::text
  Link* link = nullptr;          // not null; outlives the peer
  TokenBucket bucket{1.0, 1.0};  // limits incoming messages
  // Limits its requests; a burst is enough for all subscriptions that a peer may have.
  TokenBucket requests{kRequestsPerSecond, kRequestBurst};
  static constexpr double kRequestsPerSecond = 1000.0;
  static constexpr double kRequestBurst = 2048.0;
  // Limits its offers, which are repeated until they are answered: those of many streams must not
  // use up the requests. A burst is enough for twice the default of Limits::max_subjects.
  TokenBucket offers{kRequestsPerSecond, kOfferBurst};
  static constexpr double kOfferBurst = 4096.0;
  std::string host;         // PeerLabel::host
  bool shielded = true;     // PeerLabel::shielded
  std::string address;      // PeerLabel::address
  Access access;            // what it may do; change it by Permit()
  double rate_share = 1.0;  // part of Limits::packets_per_second that its token leaves
  Consent consent;          // UDP: whether the address still wants what it is sent
  Time last_heard{0};
  Time last_used{0};  // when it last had a subject to send or to watch, or when it connected
  int num_bound = 0;  // subscriptions that have a subject
  SkeletonRequestLimiter skeleton_requests;
  int num_subscriptions = 0;
  // At the last tick: the peer has stopped reading (Link::IsStuck()), or its consent has expired.
  bool stuck = false;
  bool goes_on_elsewhere = false;                // the next daemon goes on with it: no goodbye
  bool token_ended = false;                      // nothing is accepted from it any more
  bool publishes = false;                        // the hub has accepted an offer of this peer
  std::uint16_t last_subscription = 0;           // the newest subscription id
  std::optional<protocol::Header> list_request;  // set while the peer follows the subject list
  std::uint64_t listed_version = 0;              // SubjectRegistry::version() of the last list sent
};

}  // namespace furrow::server
