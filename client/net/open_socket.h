// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/process/descriptor.h"
#include "base/status.h"
#include "client/cpp/tls/security.h"
#include "client/net/socket.h"

namespace furrow::net {

// Connects a non-blocking socket to `host`, a name or a numeric address. TCP connections time out
// after 3 seconds. IPv4 addresses are tried before IPv6 addresses, because the daemon binds to IPv4
// by default.
//
// Errors: kUnavailable (the name does not resolve, or no address accepts the connection).
[[nodiscard]] Result<Descriptor> OpenDescriptor(client::TransportKind kind, const std::string& host,
                                                std::uint16_t port);

// Connects a TcpSocket or a UdpSocket. `security`: the token is shown to the daemon, over UDP in a
// session that begins within 3 seconds. TLS over TCP begins within client::kTlsConnectTimeout.
// `certificate_host`: the name or address in the daemon's certificate; empty: `host`.
//
// Errors: those of OpenDescriptor(); kUnavailable (also if the daemon closes the connection during
// the handshake); kInvalidArgument (the daemon refuses the token, or TLS failed).
[[nodiscard]] Result<std::unique_ptr<Socket>> OpenSocket(client::TransportKind kind,
                                                         const std::string& host,
                                                         std::uint16_t port,
                                                         const client::Security& security = {},
                                                         const std::string& certificate_host = {});

}  // namespace furrow::net
