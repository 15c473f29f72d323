// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "base/layered_stream.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_net.h"
#include "server/net/door/stranger_watch.h"
#include "server/net/tls_stream.h"
#include "server/session/peers/peer.h"
#include "server/tls/tls_context.h"

namespace furrow::server {

// A web connection with or without TLS: Beast's tcp_stream, with its timeouts, or TLS over the
// socket of one. Beast's reads, writes and WebSockets take one as they take a tcp_stream.
class WebStream {
 public:
  using executor_type = beast::tcp_stream::executor_type;

  explicit WebStream(net::ip::tcp::socket socket)
      : layers_(std::make_unique<LayeredStream<beast::tcp_stream, Tls>>(std::move(socket))) {}

  [[nodiscard]] executor_type get_executor() { return layers_->lower().get_executor(); }
  // The socket itself, for its options and addresses.
  [[nodiscard]] net::ip::tcp::socket& socket() { return layers_->lower().socket(); }
  [[nodiscard]] const net::ip::tcp::socket& socket() const { return layers_->lower().socket(); }
  // False after the stream has moved away.
  [[nodiscard]] bool is_open() const { return layers_ != nullptr && socket().is_open(); }
  [[nodiscard]] bool is_tls() const { return layers_->upper() != nullptr; }
  // True if the client has shown a certificate, which is then valid.
  [[nodiscard]] bool has_client_certificate() const;

  // What can be read is the end of the connection: no data, or the alert by which TLS ends.
  [[nodiscard]] bool HasEnded();

  // The deadline of reads and writes that begin from now on; see beast::tcp_stream.
  void expires_after(std::chrono::steady_clock::duration time) {
    if (is_tls()) return layers_->upper()->expires_at(std::chrono::steady_clock::now() + time);
    layers_->lower().expires_after(time);
  }
  void expires_never() {
    if (is_tls()) return layers_->upper()->expires_at(std::chrono::steady_clock::time_point::max());
    layers_->lower().expires_never();
  }

  // Begins TLS as the server. From then on, reads and writes are encrypted.
  [[nodiscard]] net::awaitable<beast::error_code> Handshake(TlsContext context);
  // Over TLS: holds the place of a stranger until Admit().
  void Hold(std::shared_ptr<Stranger> stranger) { stranger_ = std::move(stranger); }
  // The client has shown who it is, or need not do so.
  void Admit();
  // The client is a stranger, and others wait for its place: end the connection soon.
  [[nodiscard]] bool MustMakeRoom() const { return stranger_ != nullptr && stranger_->IsWanted(); }
  // A whole request of the client has arrived.
  void NoteRequest() {
    if (stranger_ != nullptr) stranger_->NoteRequest();
  }
  // Tells the client that nothing follows. Does not wait for it to say the same.
  [[nodiscard]] net::awaitable<void> EndSending();

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return layers_->async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return layers_->async_write_some(buffers, std::forward<Handler>(handler));
  }

 private:
  struct Tls : TlsStream<WebNet> {
    Tls(beast::tcp_stream& lower, SSL_CTX* context) : TlsStream(lower.socket(), context) {}
  };

  friend void beast_close_socket(WebStream& stream);
  template <class Handler>
  friend void async_teardown(beast::role_type role, WebStream& stream, Handler&& handler);

  std::unique_ptr<LayeredStream<beast::tcp_stream, Tls>> layers_;
  std::shared_ptr<Stranger> stranger_;  // watches the socket
};

// The client of a connection, as a peer of the hub. `kind`: of connection, for people.
[[nodiscard]] PeerLabel LabelOfClient(const WebStream& stream, const std::string& kind = "web");

// What Beast calls to end a WebSocket, at a timeout and after its close frames.
void beast_close_socket(WebStream& stream);
template <class Handler>
void async_teardown(beast::role_type role, WebStream& stream, Handler&& handler) {
  if (stream.is_tls()) {
    stream.layers_->upper()->async_end(/*awaits_client=*/false, std::forward<Handler>(handler));
  } else {
    beast::async_teardown(role, stream.layers_->lower(), std::forward<Handler>(handler));
  }
}

}  // namespace furrow::server
