// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "client/cpp/transport.h"

namespace furrow::cli {

// The address of a daemon.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

// Parses "HOST", "HOST:PORT" or "[IPV6]:PORT". Without a port, uses the protocol's port for `kind`.
// Returns false if `text` is none of these.
[[nodiscard]] bool ParseEndpoint(const std::string& text, client::TransportKind kind,
                                 Endpoint* endpoint);

// Connects to the daemon at `host` (as for ParseEndpoint()) within 3 seconds. On failure prints the
// error, sets `exit_code` and returns null; on success leaves `exit_code` unchanged.
[[nodiscard]] std::unique_ptr<client::Transport> OpenTransport(const std::string& host,
                                                               client::TransportKind kind,
                                                               int* exit_code);

// The time of a monotonic clock, microseconds.
[[nodiscard]] std::int64_t SteadyMicroseconds();
// The time of the system clock, microseconds since 1970 (UTC).
[[nodiscard]] std::int64_t SystemMicroseconds();

}  // namespace furrow::cli
