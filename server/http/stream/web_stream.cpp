// SPDX-License-Identifier: Apache-2.0
#include "server/http/stream/web_stream.h"

#include <array>
#include <cstdint>

#include "server/session/peers/peer_label.h"

namespace furrow::server {

bool WebStream::has_client_certificate() const {
  return is_tls() && layers_->upper()->has_client_certificate();
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
  layers_->AddUpper(context.get());  // takes a reference
  beast::error_code error;
  co_await layers_->upper()->async_handshake(Redirect(error));
  co_return error;
}

void WebStream::Admit() {
  if (stranger_ == nullptr) return;
  layers_->upper()->SetTrusting();
  stranger_.reset();
}

net::awaitable<void> WebStream::EndSending() {
  beast::error_code ignored;
  if (is_tls()) {
    expires_after(kWebDeadline);
    co_await layers_->upper()->async_end(/*awaits_client=*/false, Redirect(ignored));
  }
  socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
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
