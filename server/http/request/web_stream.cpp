// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/web_stream.h"

#include <array>
#include <cstdint>

#include <boost/asio/ssl/context.hpp>
#include <openssl/ssl.h>

#include "server/session/peers/peer_label.h"

namespace furrow::server {

bool WebStream::has_client_certificate() const {
  return is_tls() && SSL_get0_peer_certificate(layers_->upper()->native_handle()) != nullptr;
}

bool WebStream::HasEnded() {
  // TLS 1.3 encrypts its alerts: application data of two bytes, a type and a tag of 16 bytes
  // (RFC 8446 sections 5.2 and 6).
  static constexpr std::array<std::uint8_t, 5> kAlert = {23, 3, 3, 0, 19};
  std::array<std::uint8_t, kAlert.size()> first{};
  beast::error_code error;
  socket().non_blocking(true, error);
  const std::size_t size =
      socket().receive(net::buffer(first), net::socket_base::message_peek, error);
  if (error == net::error::would_block) return false;
  return error || size == 0 || (is_tls() && first == kAlert);
}

net::awaitable<beast::error_code> WebStream::Handshake(TlsContext context) {
  // Boost 1.74 takes no SSL object. Its context frees what it is given, so it gets a reference.
  SSL_CTX_up_ref(context.get());
  net::ssl::context own(context.get());
  layers_->AddUpper(own);
  beast::error_code error;
  co_await layers_->upper()->async_handshake(net::ssl::stream_base::server, Redirect(error));
  co_return error;
}

net::awaitable<void> WebStream::EndSending() {
  beast::error_code ignored;
  if (is_tls()) {
    expires_after(kWebDeadline);
    co_await TlsThatEnds().async_shutdown(Redirect(ignored));
  }
  socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
}

// As if the client had ended already, so that OpenSSL does not wait for it.
WebStream::Tls& WebStream::TlsThatEnds() {
  SSL_set_shutdown(layers_->upper()->native_handle(), SSL_RECEIVED_SHUTDOWN);
  return *layers_->upper();
}

PeerLabel LabelOfClient(const WebStream& stream, const std::string& kind) {
  beast::error_code error;
  const auto client = stream.socket().remote_endpoint(error);
  // It has reset the connection, and what it sent before is still read. It may be anywhere.
  if (error) return {kind + ", disconnected", {}, stream.is_tls()};
  PeerLabel label = LabelOf(kind, client.address().to_string(), client.port());
  label.shielded |= stream.is_tls();
  return label;
}

void beast_close_socket(WebStream& stream) { beast::close_socket(stream.layers_->lower()); }

}  // namespace furrow::server
