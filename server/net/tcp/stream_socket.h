// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include <asio/ip/tcp.hpp>

#include "base/layered_stream.h"
#include "server/net/asio_net.h"
#include "server/net/door/stranger_watch.h"
#include "server/net/tls_stream.h"
#include "server/tls/tls_context.h"

namespace furrow::server {

// A TCP socket with or without TLS, as asio::async_write() and the like take one.
class StreamSocket : public LayeredStream<asio::ip::tcp::socket, TlsStream<AsioNet>> {
 public:
  explicit StreamSocket(asio::ip::tcp::socket socket) : LayeredStream(std::move(socket)) {}

  // The socket itself, for its options and addresses.
  [[nodiscard]] asio::ip::tcp::socket& socket() { return lower(); }
  // True after Handshake() has begun.
  [[nodiscard]] bool is_tls() const { return upper() != nullptr; }

  // Begins TLS as the server. From then on, reads and writes are encrypted.
  [[nodiscard]] asio::awaitable<asio::error_code> Handshake(TlsContext context);
  // Over TLS: holds the place of a stranger until Admit().
  void Hold(std::shared_ptr<Stranger> stranger) { stranger_ = std::move(stranger); }
  // The client has shown who it is, or need not do so.
  void Admit();
  // Tells the client that nothing follows, and writes that. With `awaits_client`, and over TLS,
  // also waits until the client has said the same; a read may be pending.
  [[nodiscard]] asio::awaitable<void> EndSending(bool awaits_client);

 private:
  std::shared_ptr<Stranger> stranger_;
};

}  // namespace furrow::server
