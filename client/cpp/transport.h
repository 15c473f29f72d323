// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "protocol/secure/handshake/handshake_packets.h"
#include "protocol/secure/token/connect_token.h"

namespace furrow::client {

using Token = protocol::secure::ClientToken;

// The network protocol below a transport.
enum class TransportKind { kUdp, kTcp };

// Another server of the daemon's cluster.
struct Elsewhere {
  std::string host;  // a name or a numeric address, without brackets
  std::uint16_t tcp = 0;
  std::uint16_t udp = 0;
  friend bool operator==(const Elsewhere&, const Elsewhere&) = default;
};
// "HOST:TCP:UDP", as in Welcome; nothing if it is not.
[[nodiscard]] std::optional<Elsewhere> ParseElsewhere(std::string_view text);

// The outcome of one send or receive.
enum class IoStatus {
  kOk = 0,
  kTimeout,       // nothing arrived in time
  kClosed,        // TCP: the peer closed the connection; no more messages follow
  kNoConnection,  // no peer: refused, unreachable or unresolved
  kTooLarge,      // the message exceeds what this transport carries
  kMalformed,     // the received framing is invalid; a TCP connection is closed then
};

// One connected socket that carries whole messages of the Furrow protocol (protocol/STANDARD.md).
//
// Over TCP each message has a length prefix. Over UDP a message is one datagram or several
// fragments; received datagrams may also be bundles of messages.
//
// Not thread-safe: use each transport on one thread. No call blocks beyond the given timeout,
// except that the system's name resolver takes its own time.
class Transport {
 public:
  virtual ~Transport() = default;

  // Sends `message`, as protocol::Encoder writes it. Over TCP kClosed also means that the peer took
  // longer than the timeout; the connection is then closed.
  [[nodiscard]] virtual IoStatus Send(std::span<const std::uint8_t> message) = 0;

  // Waits up to `timeout` for one whole message (0: does not wait). On kOk, `message` points into
  // the transport and is valid until the next call; otherwise it is unspecified. Returns kTimeout
  // early when a connection is complete, so that the caller can send.
  [[nodiscard]] virtual IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) = 0;

  // True if Receive() splits bundles (protocol/framing/bundle.h), so the daemon may send them.
  [[nodiscard]] virtual bool takes_bundles() const { return false; }

  // True once messages can be sent.
  [[nodiscard]] virtual bool connected() const { return true; }
  // An attempt to connect that takes longer, counted from its start, has failed. May grow while the
  // attempt makes progress.
  [[nodiscard]] virtual std::chrono::microseconds connect_timeout() const {
    return std::chrono::seconds(3);
  }
  // The system's reason of the last failed attempt to connect; empty if none failed.
  [[nodiscard]] virtual std::string failure() const { return {}; }

  // Why the daemon refuses the token, kNone if it does not. Nothing proves it.
  [[nodiscard]] virtual protocol::secure::Refusal refusal() const {
    return protocol::secure::Refusal::kNone;
  }

  // True if the newest attempt to connect, or the connection itself, failed in TLS: the certificate
  // is not trusted, or the daemon does not speak TLS or wants a certificate of the client. False if
  // the daemon only closed the connection during the handshake, because it may be busy.
  [[nodiscard]] virtual bool tls_failed() const { return false; }

  // True for transports that connect again after a loss (client/cpp/reconnecting_transport.h).
  [[nodiscard]] virtual bool reconnects() const { return false; }
  // Number of connections so far. A peer knows nothing of an earlier connection.
  [[nodiscard]] virtual std::uint64_t generation() const { return 1; }
  // Gives up a connection whose peer has stopped answering, if the transport can make another.
  virtual void Abandon() {}

  // Goes on at another server, because the daemon said so. False: this transport never does. True
  // also if it stays for now, because that server was lost a moment ago or because servers have
  // sent it to and fro: ask again later.
  [[nodiscard]] virtual bool GoTo(const Elsewhere& /*server*/) { return false; }
  // Servers to try if this one is lost.
  virtual void Remember(std::span<const Elsewhere> /*others*/) {}
  [[nodiscard]] virtual bool has_others() const { return false; }

  [[nodiscard]] TransportKind kind() const { return kind_; }

 protected:
  explicit Transport(TransportKind kind) : kind_(kind) {}

 private:
  TransportKind kind_;
};

// "host:port", with brackets around an IPv6 address.
[[nodiscard]] std::string AddressText(const std::string& host, std::uint16_t port);

// The first message over TCP of a client with a token: a Hello that shows it.
[[nodiscard]] std::vector<std::uint8_t> TokenGreeting(const Token& token);

// "the daemon refuses the token: the token has expired"; empty unless the refusal Lasts().
[[nodiscard]] std::string RefusedTokenText(protocol::secure::Refusal refusal);

// The kUnavailable status of a failed connect: "no connection to host:port over TCP: reason".
[[nodiscard]] Status ConnectionFailed(TransportKind kind, const std::string& host,
                                      std::uint16_t port, std::string_view reason);
// The kUnavailable status of a TLS handshake that the daemon ended without an alert (`is_closed`),
// or that took too long. A busy daemon does both, so another attempt may succeed.
[[nodiscard]] Status HandshakeCut(const std::string& host, std::uint16_t port, bool is_closed);
// The kUnavailable status of a host name that has no address, with what to do.
[[nodiscard]] Status HostNotFound(const std::string& host);

}  // namespace furrow::client
