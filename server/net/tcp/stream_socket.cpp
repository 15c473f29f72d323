// SPDX-License-Identifier: Apache-2.0
#include "server/net/tcp/stream_socket.h"

#include "server/net/await_tuple.h"

namespace furrow::server {

asio::awaitable<asio::error_code> StreamSocket::Handshake(TlsContext context) {
  AddUpper(context.get());  // takes a reference
  const auto [error] = co_await upper()->async_handshake(kAwaitTuple);
  co_return error;
}

void StreamSocket::Admit() {
  if (is_tls()) upper()->SetTrusting();
  stranger_.reset();
}

asio::awaitable<void> StreamSocket::EndSending(bool awaits_client) {
  if (is_tls()) co_await upper()->async_end(awaits_client, kAwaitTuple);
  asio::error_code ignored;
  socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace furrow::server
