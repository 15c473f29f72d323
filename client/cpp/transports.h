// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "base/status.h"
#include "client/cpp/transport.h"

namespace furrow::client {

// Connects to `host`, a name or a numeric address. `timeout` limits the connect, and over TCP
// each later Send() to a slow peer. UDP has no handshake: Receive() reports a missing server.
//
// `token`: shown to the daemon, or null. Over UDP it begins a secure session, which the function
// waits for; over TCP everybody on the way can read it.
//
// Errors: kUnavailable (the name does not resolve, or the peer does not accept the connection),
// kInvalidArgument (the daemon refuses the token).
[[nodiscard]] Result<std::unique_ptr<Transport>> OpenTransport(TransportKind kind,
                                                               const std::string& host,
                                                               std::uint16_t port,
                                                               std::chrono::milliseconds timeout,
                                                               const Token* token = nullptr);
// Begins to connect and returns at once, except for the time of the name resolver. Over TCP, and
// with a token, the connection is complete once connected() is true; until then Receive() waits
// for that, and Send() returns kNoConnection. `send_timeout` limits each Send() to a slow TCP
// peer.
//
// Errors: kUnavailable (the name does not resolve, or there is no route).
[[nodiscard]] Result<std::unique_ptr<Transport>> BeginTransport(
    TransportKind kind, const std::string& host, std::uint16_t port,
    std::chrono::milliseconds send_timeout, const Token* token = nullptr);

}  // namespace furrow::client
