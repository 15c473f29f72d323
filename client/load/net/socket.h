// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "client/cpp/transport.h"

namespace furrow::load {

// A file descriptor that is closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

// A connected socket that does not block; `error` says why where there is none (-1).
[[nodiscard]] Descriptor OpenDescriptor(client::TransportKind kind, const std::string& host,
                                        std::uint16_t port, std::string* error);

// The numeric address that a connected socket goes to; empty where it is not.
[[nodiscard]] std::string PeerHost(int descriptor);

// A transport of the load tester: as client::Transport's own, but made for many messages a second
// on one thread. It never waits when it is not asked to, has a descriptor to wait for many at once,
// takes datagrams in batches and counts those that its own full buffer lost.
class Socket : public client::Transport {
 public:
  // Null where it fails, and `error` says why in one sentence.
  [[nodiscard]] static std::unique_ptr<Socket> Open(client::TransportKind kind,
                                                    const std::string& host, std::uint16_t port,
                                                    std::string* error);

  // Readable when Receive() with no timeout has something; level-triggered.
  [[nodiscard]] virtual int descriptor() const = 0;
  // Whether Receive() has something that the descriptor does not show any more.
  [[nodiscard]] virtual bool holds() const = 0;
  // When what Receive() gave last came in here, on the clock of SteadyNanoseconds(): over UDP as
  // the system stamped it, so however late it was read; over TCP when it was read.
  [[nodiscard]] virtual std::int64_t arrived_ns() const = 0;
  // Datagrams that came and found no room here: not the server's fault.
  [[nodiscard]] virtual std::uint64_t overrun() const { return 0; }

 protected:
  using client::Transport::Transport;
};

// Waits until `descriptor` has one of poll()'s `events`; false when time is up.
bool WaitFor(int descriptor, short events, std::chrono::milliseconds timeout);

}  // namespace furrow::load
