// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <asio/steady_timer.hpp>

#include "base/status.h"
#include "protocol/framing/fragment.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/net/udp/secure_sessions.h"
#include "server/net/udp/udp_batch.h"
#include "server/net/udp/udp_sender.h"
#include "server/saved/saved_state.h"
#include "server/session/hub.h"
#include "server/session/peers/reception.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// The UDP socket of one shard: receives and sends datagrams in batches, reassembles fragments, and
// keeps one peer per address.
//
// An address becomes a peer when it has proved that it receives what is sent to it (Reception). A
// peer has one session number, which it alone knows: datagrams with another one are a stranger's.
// At most Limits::max_udp_peers peers are remembered, shared fairly between hosts.
//
// Sealed datagrams belong to secure sessions, each of which is a peer, wherever its client is.
class UdpServer : public BufferedSender {
 public:
  // `recording`: optional; receives every datagram of a peer, opened. `secure`: the sessions of all
  // shards; null: sealed datagrams are malformed. `requires_token`: plain datagrams are refused.
  UdpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
            RecordingTap* recording = nullptr, int shard = 0, SecureSessions* secure = nullptr,
            bool requires_token = false);
  ~UdpServer() override;
  UdpServer(const UdpServer&) = delete;
  UdpServer& operator=(const UdpServer&) = delete;

  // kOwn: only this socket uses the port. kShared: several sockets of this daemon use the port, and
  // the kernel assigns each sender to one of them (SO_REUSEPORT).
  enum class Port { kOwn, kShared };
  // Errors: kUnavailable; the message names the address and the port. A kShared port must not be in
  // use by a socket that does not share it.
  [[nodiscard]] Status Open(const asio::ip::udp::endpoint& endpoint, Port port = Port::kOwn);
  // Lets other sockets open the port as kShared from now on.
  [[nodiscard]] Status Share();
  // Sets the servers of all shards. What a shard publishes leaves through the shard's own socket,
  // even if the receiving peer belongs to another shard. Call it before Start().
  void Join(std::vector<UdpServer*> by_shard) { by_shard_ = std::move(by_shard); }
  // Uses a UDP socket that is bound already, instead of Open(). Errors: kUnavailable. The socket is
  // closed then.
  [[nodiscard]] Status Adopt(int socket);
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] int socket() { return socket_.native_handle(); }
  // Drops the datagrams that have arrived since Open(). Call it before Start().
  void DropWaiting();
  // Looks for datagrams for up to `time` after the last ones of peers before the thread sleeps: a
  // wake-up takes longer than a pose. 0: never. Call it before Open() or Adopt().
  void SetBusyPoll(Time time) { busy_poll_ = time; }
  // Starts reading. Fatal errors propagate out of the event loop.
  void Start();
  // Stops reading and closes the socket.
  void Close();

  // For a restart: reads no further datagrams, which wait for the next daemon. Thread-safe.
  void StopReading() { stops_reading_ = true; }
  // Saves the peers for the next daemon. Call it on the shard's thread or after that
  // has ended.
  void Save(std::vector<SavedUdpPeer>* peers);
  // Goes on with a peer of the former daemon. `access`: of its secure session, which is here
  // already. 0: it has no place.
  [[nodiscard]] PeerId Resume(const SavedUdpPeer& saved, std::optional<Access> access, Time now);

  // Sends the shard's messages to UDP peers.
  void Flush() override;

  // Forgets idle peers and incomplete messages. Call it about once per second.
  void Expire(Time now);

 private:
  class UdpPeer;
  using Address = UdpAddress;
  struct AddressHash {
    std::size_t operator()(const Address& address) const {
      return std::hash<std::string_view>()(
          {reinterpret_cast<const char*>(address.data()), address.size()});
    }
  };

  // A packet of a secure session that proved to be its client's.
  struct SessionPacket {
    std::uint32_t session = 0;
    bool closed = false;
    std::optional<Access> access;        // the token was renewed
    std::vector<std::uint8_t> datagram;  // opened; may be empty
  };
  // What a datagram's bytes may be used for: a batch keeps them until the shard's lock ends.
  enum class Lifetime : std::uint8_t { kBatch, kCall };

  asio::awaitable<void> Read();
  [[nodiscard]] bool IsReading() const { return socket_.is_open() && !stops_reading_; }
  void PrepareSocket(bool adopted);
  bool ReadBatches();
  void Poll();
  void HandleBatch(std::size_t count);
  void OnDatagram(std::span<std::uint8_t> bytes, const asio::ip::udp::endpoint& sender, Time now);
  void OnPlain(std::span<const std::uint8_t> bytes, const asio::ip::udp::endpoint& sender,
               Time now);
  void OnSealed(std::span<std::uint8_t> bytes, const asio::ip::udp::endpoint& sender, Time now);
  void OnSessionPacket(const SessionPacket& packet, Time now);
  void PassOn(int shard, SessionPacket packet);
  void Deliver(const UdpPeer& peer, std::span<const std::uint8_t> bytes, Lifetime lifetime,
               Time now);
  void DeliverOpened(const UdpPeer& peer, std::span<const std::uint8_t> bytes, Lifetime lifetime,
                     Time now);
  UdpPeer& AddSealed(std::uint32_t session, const Access& access,
                     const asio::ip::udp::endpoint& sender, Time now);
  void ForgetSealed(std::uint32_t session);
  void ForgetClosed();
  void SendToStranger(std::span<const std::uint8_t> datagram, const asio::ip::udp::endpoint& to);
  static Address AddressOf(const asio::ip::udp::endpoint& sender);
  UdpPeer* Find(const Address& address, std::uint64_t session);
  UdpPeer* Receive(const Address& address, const asio::ip::udp::endpoint& sender,
                   std::uint64_t session, std::span<const std::uint8_t> bytes, Time now);
  UdpPeer* Add(const Address& address, const asio::ip::udp::endpoint& sender, std::uint64_t session,
               Time now);
  void SaveOne(const UdpPeer& peer, std::vector<SavedUdpPeer>* peers);
  void Forget(const UdpPeer& peer);
  void ReleaseInTime();

  asio::io_context& io_;
  asio::ip::udp::socket socket_;
  Hub* const hub_;
  Metrics* const metrics_;
  RecordingTap* const recording_;
  const int shard_;
  std::vector<UdpServer*> by_shard_;
  UdpBatch batch_;
  UdpSender sender_;
  SecureSessions* const secure_;
  Reception reception_;
  FairShare shares_;                 // of the peers
  std::uint64_t num_strangers_ = 0;  // that were answered
  protocol::Reassembler reassembler_;
  std::unordered_map<Address, std::unique_ptr<UdpPeer>, AddressHash> peers_;
  std::unordered_map<std::uint32_t, std::unique_ptr<UdpPeer>> sealed_;  // by secure session
  // Wakes up for poses that wait for an earlier one.
  asio::steady_timer release_;
  std::optional<Time> release_at_;  // none: not armed
  std::atomic<bool> stops_reading_ = false;
  Time busy_poll_{0};
  Time busy_until_{0};
  std::uint64_t num_of_peers_ = 0;  // datagrams received from peers
  // Packets that other shards have passed on and that wait for this shard's thread.
  std::atomic<int> num_passed_ = 0;
};

}  // namespace furrow::server
