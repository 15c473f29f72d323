// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "client/cpp/transport.h"

namespace furrow::cli {

// The address of a daemon. The port defaults to the protocol's port of the transport.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

// Parses "HOST", "HOST:PORT" or "[IPV6]:PORT". Returns false if `text` is none of these.
[[nodiscard]] bool ParseEndpoint(const std::string& text, client::TransportKind kind,
                                 Endpoint* endpoint);

// Connects to a daemon within 3 seconds. On failure prints the error, sets `exit_code` and returns
// null.
[[nodiscard]] std::unique_ptr<client::Transport> OpenTransport(const std::string& host,
                                                               client::TransportKind kind,
                                                               int* exit_code);

// Microseconds of a monotonic clock, and microseconds since 1970 (UTC).
[[nodiscard]] std::int64_t SteadyMicroseconds();
[[nodiscard]] std::int64_t SystemMicroseconds();

}  // namespace furrow::cli
