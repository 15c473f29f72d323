// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <asio/ip/tcp.hpp>
#include <asio/ssl/stream.hpp>

#include "base/layered_stream.h"
#include "server/net/await_tuple.h"
#include "server/tls/tls_context.h"

namespace furrow::server {

// A TCP socket with or without TLS, as asio::async_write() and the like take one.
class StreamSocket
    : public LayeredStream<asio::ip::tcp::socket, asio::ssl::stream<asio::ip::tcp::socket&>> {
 public:
  explicit StreamSocket(asio::ip::tcp::socket socket) : LayeredStream(std::move(socket)) {}

  // The socket itself, for its options and addresses.
  [[nodiscard]] asio::ip::tcp::socket& socket() { return lower(); }
  // True after Handshake() has begun.
  [[nodiscard]] bool is_tls() const { return upper() != nullptr; }

  // Begins TLS as the server. From then on, reads and writes are encrypted.
  [[nodiscard]] asio::awaitable<asio::error_code> Handshake(TlsContext context);
  // Tells the client that nothing follows, and writes that. With `awaits_client`, and over TLS,
  // also waits until the client has said the same; a read may be pending.
  [[nodiscard]] asio::awaitable<void> EndSending(bool awaits_client);
};

}  // namespace furrow::server
