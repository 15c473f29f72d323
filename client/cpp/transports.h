// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "base/status.h"
#include "client/cpp/tls/security.h"
#include "client/cpp/transport.h"

namespace furrow::client {

// Connects to `host`, a name or a numeric address. `timeout` limits the connect, and over TCP
// each later Send() to a slow peer. UDP has no handshake: Receive() reports a missing server.
//
// With a token over UDP, waits for the secure session that it begins; with TLS over TCP, for the
// handshake. A daemon that is busy may close the connection
// during the handshake; until `timeout` has passed, the function tries again. kTlsConnectTimeout is
// long enough.
//
// Errors: kUnavailable (the name does not resolve, or the peer does not accept the connection),
// kInvalidArgument (the daemon refuses the token, its certificate is not trusted, or the token
// would travel to another computer unencrypted).
[[nodiscard]] Result<std::unique_ptr<Transport>> OpenTransport(TransportKind kind,
                                                               const std::string& host,
                                                               std::uint16_t port,
                                                               std::chrono::milliseconds timeout,
                                                               const Security& security = {});
// Begins to connect and returns at once, except for the time of the name resolver. Over TCP, and
// with a token, the connection is complete once connected() is true; until then Receive() waits
// for that, and Send() returns kNoConnection. `send_timeout` limits each Send() to a slow TCP
// peer.
//
// Errors: kUnavailable (the name does not resolve, or there is no route), kInvalidArgument (the
// token would travel to another computer unencrypted).
[[nodiscard]] Result<std::unique_ptr<Transport>> BeginTransport(
    TransportKind kind, const std::string& host, std::uint16_t port,
    std::chrono::milliseconds send_timeout, const Security& security = {});

}  // namespace furrow::client
