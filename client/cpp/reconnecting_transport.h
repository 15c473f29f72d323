// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/backoff.h"
#include "client/cpp/tls/security.h"
#include "client/cpp/transport.h"

namespace furrow::client {

// A transport that opens its connection by itself, and again after every loss.
//
// While there is no connection, Send() and Receive() return kNoConnection; they never return
// kClosed or kMalformed. Attempts happen inside Receive(), with growing pauses between them.
// generation() counts the connections: Subscriber and Publisher start over when it changes.
//
// Over TCP each loss leads to a new connection. Over UDP the socket is kept while the port is
// closed, and opened again after 5 seconds without a message, because the network may have changed.
class ReconnectingTransport : public Transport {
 public:
  // Starts one attempt, without waiting for its end (BeginTransport()).
  using Opener = std::function<Result<std::unique_ptr<Transport>>()>;
  // The same for another server.
  using OpenerAt = std::function<Result<std::unique_ptr<Transport>>(const Elsewhere& server)>;
  // The time of a monotonic clock, microseconds.
  using Clock = std::function<std::int64_t()>;

  // `first`: an open connection to begin with, or null.
  ReconnectingTransport(TransportKind kind, Opener open, Clock now_us, const Backoff& backoff,
                        std::unique_ptr<Transport> first = nullptr);

  // The usual one: the steady clock, and the default limits of Backoff. Does not connect yet.
  // `send_timeout`, `security`: as for BeginTransport(). Follows, except over TCP with a token,
  // unless the user has named the authority of the certificates.
  [[nodiscard]] static std::unique_ptr<ReconnectingTransport> Create(
      TransportKind kind, const std::string& host, std::uint16_t port,
      std::chrono::milliseconds send_timeout, std::unique_ptr<Transport> first = nullptr,
      Security security = {});

  // Lets the transport go to other servers of the daemon's cluster: when the daemon sends it there,
  // at most kMostMoves times in kMoveWindow, and when the connection is lost. Whoever is met there
  // must prove the same as the first daemon: the opener shows the same token and checks the same
  // certificates.
  void FollowBy(OpenerAt open_at) { open_at_ = std::move(open_at); }
  static constexpr std::size_t kMostMoves = 4;
  static constexpr std::chrono::microseconds kMoveWindow = std::chrono::seconds(10);

  [[nodiscard]] IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] IoStatus Receive(std::span<const std::uint8_t>& message,
                                 std::chrono::milliseconds timeout) override;
  [[nodiscard]] bool takes_bundles() const override { return kind() == TransportKind::kUdp; }
  [[nodiscard]] bool connected() const override { return up_; }
  [[nodiscard]] bool reconnects() const override { return true; }
  [[nodiscard]] std::uint64_t generation() const override { return generation_; }
  void Abandon() override { abandoned_ = true; }
  [[nodiscard]] std::string failure() const override { return failure_; }
  [[nodiscard]] protocol::secure::Refusal refusal() const override { return refusal_; }
  [[nodiscard]] bool tls_failed() const override { return tls_failed_; }
  [[nodiscard]] bool GoTo(const Elsewhere& server) override;
  void Remember(std::span<const Elsewhere> others) override;
  [[nodiscard]] bool has_others() const override { return servers_.size() > 1; }

 private:
  bool Open(std::int64_t now_us);
  void TryNext(std::int64_t now_us);
  void Lose(std::int64_t now_us);
  IoStatus Rest(std::int64_t now_us, std::chrono::milliseconds timeout) const;
  IoStatus OnFailure(std::int64_t now_us);

  Opener open_;
  OpenerAt open_at_;  // empty: only the first server
  // The first one, which `open_` connects to and whose address stays empty here, and others.
  std::vector<Elsewhere> servers_{{}};
  std::size_t server_ = 0;              // the present one in servers_
  std::vector<std::int64_t> moves_us_;  // when the daemon sent it away
  bool moves_ = false;                  // it has just done so
  std::optional<Elsewhere> lost_;       // the server that was lost last, and when
  std::int64_t lost_us_ = 0;
  Clock now_us_;
  Backoff backoff_;
  std::unique_ptr<Transport> inner_;  // null between a loss and the next attempt
  bool up_ = false;                   // inner_ is connected
  bool abandoned_ = false;            // close inner_ at the next Receive()
  std::uint64_t generation_ = 0;
  std::uint64_t inner_generation_ = 0;  // of inner_, that generation_ has counted
  protocol::secure::Refusal refusal_ = protocol::secure::Refusal::kNone;
  std::int64_t opened_us_ = 0;                    // when the attempt of inner_ began
  std::int64_t up_us_ = 0;                        // when inner_ was connected
  std::optional<std::int64_t> failing_since_us_;  // UDP: first failure without a message since
  std::string failure_;
  bool tls_failed_ = false;
};

}  // namespace furrow::client
