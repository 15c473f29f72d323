// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::client {

// The network protocol below a transport.
enum class TransportKind { kUdp, kTcp };

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
  // Connects to `host`, a name or a numeric address. `timeout` limits the connect, and over TCP
  // each later Send() to a slow peer. UDP has no handshake: Receive() reports a missing server.
  //
  // Errors: kUnavailable (the name does not resolve, or the peer does not accept the connection).
  [[nodiscard]] static Result<std::unique_ptr<Transport>> Open(TransportKind kind,
                                                               const std::string& host,
                                                               std::uint16_t port,
                                                               std::chrono::milliseconds timeout);
  virtual ~Transport() = default;

  // Sends `message`, as protocol::Encoder writes it. Over TCP kClosed also means that the peer took
  // longer than the timeout; the connection is then closed.
  [[nodiscard]] virtual IoStatus Send(std::span<const std::uint8_t> message) = 0;

  // Waits up to `timeout` for one whole message (0: does not wait). On kOk, `message` points into
  // the transport and is valid until the next call; otherwise it is unspecified.
  [[nodiscard]] virtual IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) = 0;

  // True if Receive() splits bundles (protocol/framing/bundle.h), so the daemon may send them.
  [[nodiscard]] virtual bool takes_bundles() const { return false; }

  [[nodiscard]] TransportKind kind() const { return kind_; }

 protected:
  explicit Transport(TransportKind kind) : kind_(kind) {}

 private:
  TransportKind kind_;
};

// "host:port", with brackets around an IPv6 address.
[[nodiscard]] std::string AddressText(const std::string& host, std::uint16_t port);

// The kUnavailable status of a failed connect: "no connection to host:port over TCP: reason".
[[nodiscard]] Status ConnectionFailed(TransportKind kind, const std::string& host,
                                      std::uint16_t port, std::string_view reason);

}  // namespace furrow::client
