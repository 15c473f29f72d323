// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "client/cpp/transport.h"

namespace furrow::cli {

// Where a daemon is: "HOST", "HOST:PORT" or "[V6]:PORT"; the port defaults to the transport's.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

// False when the text is none of these.
[[nodiscard]] bool ParseEndpoint(const std::string& text, client::TransportKind kind,
                                 Endpoint* endpoint);

// Opens, or prints why not and returns null; `exit_code` is then what to exit with.
[[nodiscard]] std::unique_ptr<client::Transport> OpenTransport(const std::string& host,
                                                               client::TransportKind kind,
                                                               int* exit_code);

// Microseconds: on a clock that does not go back, and since 1970.
[[nodiscard]] std::int64_t SteadyMicroseconds();
[[nodiscard]] std::int64_t SystemMicroseconds();

}  // namespace furrow::cli
