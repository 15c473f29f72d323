// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace furrow::client {

enum class TransportKind { kUdp, kTcp };

enum class IoStatus {
  kOk = 0,
  kTimeout,       // nothing came in time
  kClosed,        // TCP: the other end closed; nothing more will come
  kNoConnection,  // nobody there: refused, unreachable, or not resolved
  kTooLarge,      // a message beyond what this transport carries
  kMalformed,     // what came is not framed as it should be; TCP is closed then
};

// One connected socket that carries whole messages of the Furrow protocol (protocol/STANDARD.md):
// length-prefixed over TCP; over UDP one a datagram or in fragments, and received in bundles, too.
//
// Not thread-safe: one thread a transport. Waits never beyond the times given, except that the
// system's resolver takes its own time over a name.
class Transport {
 public:
  // `host`: a name or a numeric address. `timeout`: for connecting, and over TCP for each Send()
  // that the other end is slow to take. On failure null, and `error` says why in one sentence. UDP
  // has no handshake: a missing server shows in Receive().
  [[nodiscard]] static std::unique_ptr<Transport> Open(TransportKind kind, const std::string& host,
                                                       std::uint16_t port,
                                                       std::chrono::milliseconds timeout,
                                                       std::string* error);
  virtual ~Transport() = default;

  // `message` as protocol::Encoder makes it. kClosed over TCP also when the other end took too
  // long; the connection is closed then.
  [[nodiscard]] virtual IoStatus Send(std::span<const std::uint8_t> message) = 0;

  // Waits for one whole message, at most `timeout` (0: only what is there). `message` points into
  // the transport and is valid until the next call.
  [[nodiscard]] virtual IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) = 0;

  // Whether Receive() takes bundles apart (protocol/framing/bundle.h), so that the daemon may send
  // some.
  [[nodiscard]] virtual bool takes_bundles() const { return false; }

  [[nodiscard]] TransportKind kind() const { return kind_; }

 protected:
  explicit Transport(TransportKind kind) : kind_(kind) {}

 private:
  TransportKind kind_;
};

}  // namespace furrow::client
