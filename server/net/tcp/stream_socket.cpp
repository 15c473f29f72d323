// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/stream_socket.h"

#include <new>

#include <openssl/ssl.h>

namespace furrow::server {

asio::awaitable<asio::error_code> StreamSocket::Handshake(TlsContext context) {
  SSL* const ssl = SSL_new(context.get());
  if (ssl == nullptr) throw std::bad_alloc();
  AddUpper(ssl);  // takes the SSL object over, which holds the context
  const auto [error] =
      co_await upper()->async_handshake(asio::ssl::stream_base::server, kAwaitTuple);
  co_return error;
}

asio::awaitable<void> StreamSocket::EndSending(bool awaits_client) {
  if (is_tls()) {
    // As if the client had said so already, so that OpenSSL does not wait for it.
    if (!awaits_client) SSL_set_shutdown(upper()->native_handle(), SSL_RECEIVED_SHUTDOWN);
    co_await upper()->async_shutdown(kAwaitTuple);
  }
  asio::error_code ignored;
  socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace furrow::server
