// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "client/cpp/transport.h"

namespace furrow::net {

// A transport for tools that exchange many messages per second on one thread: the load tester and
// the chaos proxy.
//
// In addition to client::Transport it never blocks unless a timeout is given, exposes its
// descriptor so that a Poller can wait for many sockets, reads datagrams in batches, and counts the
// datagrams that its own full buffer dropped.
class Socket : public client::Transport {
 public:
  // The descriptor of the socket, owned by this object. It is readable when data has arrived that
  // Receive() has not read yet.
  [[nodiscard]] virtual int descriptor() const = 0;
  // True if Receive() can return messages that were already read from the descriptor, which
  // therefore does not report them.
  [[nodiscard]] virtual bool holds() const = 0;
  // Arrival time of the message that Receive() returned last, on the clock of SteadyNanoseconds().
  // UDP uses the kernel's time stamp, so a late read does not change it. TCP uses the time of the
  // read.
  [[nodiscard]] virtual std::int64_t arrived_ns() const = 0;
  // Number of datagrams that arrived at this machine and were dropped because the receive buffer
  // was full. The server sent them, so they are not its losses.
  [[nodiscard]] virtual std::uint64_t overrun() const { return 0; }

 protected:
  using client::Transport::Transport;
};

}  // namespace furrow::net
