// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include <asio/ip/udp.hpp>

#include "protocol/secure/session/secure_server.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/net/udp/datagram_sealer.h"
#include "server/saved/saved_state.h"
#include "server/session/access/access.h"
#include "server/session/access/refusal_log.h"
#include "server/session/access/token_gate.h"

namespace furrow::server {

// The secure sessions of a daemon, for the UDP servers of all shards. A token counts once for the
// whole daemon, and a client that changes its address may reach another shard's socket; so there is
// one table, behind one lock. The lock is held for about a microsecond per datagram.
class SecureSessions : public DatagramSealer {
 public:
  // `gate`, `metrics`: not null; outlive this object. `shards`: their number.
  SecureSessions(const TokenGate* gate, std::function<std::uint64_t()> unix_now, int max_sessions,
                 int shards, Metrics* metrics);

  // What a datagram means. Its bytes and `hello` belong to the caller.
  struct Outcome {
    protocol::secure::ServerEvent event;
    int shard = 0;                 // that the session belongs to
    std::optional<Access> access;  // if the session opened or its token was renewed
  };
  // Handles a datagram that IsSecure() accepts, and opens it in place. `shard`: of the socket that
  // received it; new sessions belong to that shard.
  [[nodiscard]] Outcome OnDatagram(std::span<std::uint8_t> bytes,
                                   const asio::ip::udp::endpoint& from, int shard, Time now);
  [[nodiscard]] bool Seal(std::uint32_t session, std::span<std::uint8_t> packet,
                          asio::ip::udp::endpoint& to) override;

  // Ends all sessions and returns those that another process can go on with. Nothing is sealed
  // afterwards.
  [[nodiscard]] std::vector<SavedSecureSession> TakeAll();
  // Goes on with a session of a former process. Nothing: it has ended (SecureServer::Resume()).
  [[nodiscard]] std::optional<Access> Resume(const SavedSecureSession& saved, Time now);

  // Replaces the keys. Sessions end whose keys are no longer there.
  void SetKeys(protocol::secure::KeyRing keys);
  void Close(std::uint32_t session);
  // Ends sessions that are silent or whose tokens have expired. Call it about once per second.
  void Expire(Time now);
  // The sessions of the shard that have ended since the last call.
  [[nodiscard]] std::vector<std::uint32_t> TakeClosed(int shard);
  [[nodiscard]] bool HasClosed(int shard) const {
    return has_closed_[static_cast<std::size_t>(shard)].load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t kPlaces = 0x10000;
  static std::size_t PlaceOf(std::uint32_t session) { return session & 0xFFFF; }
  [[nodiscard]] protocol::secure::Now At(Time now) const;
  // What the token of a session allows.
  [[nodiscard]] Access AccessOf(std::uint32_t session, Time now) const;
  void Count(const protocol::secure::ServerEvent& event);
  void SortClosed();

  const TokenGate* const gate_;
  const std::function<std::uint64_t()> unix_now_;
  Metrics* const metrics_;
  std::mutex mutex_;  // guards everything below
  protocol::secure::SecureServer server_;
  RefusalLog refusals_;
  std::uint64_t retries_ = 0;                       // of server_, that were counted
  std::vector<std::uint8_t> shard_of_;              // by the place of the session
  std::vector<bool> is_v4_;                         // by the place of the session
  std::vector<std::uint32_t> scope_of_;             // by the place of the session; see ScopeOf()
  std::vector<std::vector<std::uint32_t>> closed_;  // by shard
  std::vector<std::atomic<bool>> has_closed_;       // by shard; read without the lock
};

}  // namespace furrow::server
