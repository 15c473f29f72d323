// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/status.h"
#include "client/net/descriptor.h"
#include "client/net/socket.h"

namespace furrow::net {

// Connects a non-blocking socket to `host`, a name or a numeric address. TCP connections time out
// after 3 seconds. IPv4 addresses are tried before IPv6 addresses, because the daemon binds to IPv4
// by default.
//
// Errors: kUnavailable (the name does not resolve, or no address accepts the connection).
[[nodiscard]] Result<Descriptor> OpenDescriptor(client::TransportKind kind, const std::string& host,
                                                std::uint16_t port);

// Connects a TcpSocket or a UdpSocket. `token`: shown to the daemon, or null; over UDP the session
// begins within 3 seconds. Errors: those of OpenDescriptor(); kInvalidArgument (the daemon refuses
// the token).
[[nodiscard]] Result<std::unique_ptr<Socket>> OpenSocket(client::TransportKind kind,
                                                         const std::string& host,
                                                         std::uint16_t port,
                                                         const client::Token* token = nullptr);

}  // namespace furrow::net
