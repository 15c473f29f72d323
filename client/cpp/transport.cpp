// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/transport.h"

#include <charconv>
#include <cstddef>

#include "protocol/codec/codec.h"
#include "protocol/secure/token/token_text.h"

namespace furrow::client {

std::string AddressText(const std::string& host, std::uint16_t port) {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::vector<std::uint8_t> TokenGreeting(const Token& token) {
  protocol::Hello hello;
  hello.access = ToText(token);
  std::vector<std::uint8_t> bytes;
  protocol::Header header;
  header.session = 1;  // any number: over TCP it proves nothing
  protocol::Encoder().Encode(header, hello, bytes);
  return bytes;
}

std::string RefusedTokenText(protocol::secure::Refusal refusal) {
  return Lasts(refusal) ? std::string("the daemon refuses the token: ") + RefusalText(refusal)
                        : std::string();
}

Status ConnectionFailed(TransportKind kind, const std::string& host, std::uint16_t port,
                        std::string_view reason) {
  return {StatusCode::kUnavailable, "no connection to " + AddressText(host, port) + " over " +
                                        (kind == TransportKind::kTcp ? "TCP: " : "UDP: ") +
                                        std::string(reason)};
}

Status HandshakeCut(const std::string& host, std::uint16_t port, bool is_closed) {
  const std::string what = is_closed
                               ? "the daemon closed the connection during the TLS handshake: it"
                               : "the TLS handshake took too long: the daemon";
  return {StatusCode::kUnavailable,
          "no connection to " + AddressText(host, port) + " over TLS: " + what +
              " is busy with other clients of this address, or does not speak TLS at this port",
          "", "try again later, or leave out tls=1 and --tls"};
}

Status HostNotFound(const std::string& host) {
  // The resolver's own words ("Host not found (authoritative)") do not say what to do.
  return {StatusCode::kUnavailable, "no connection to " + host + ": no host of this name was found",
          "", "check the name and the network, or use a numeric address"};
}

std::optional<Elsewhere> ParseElsewhere(std::string_view text) {
  Elsewhere server;
  for (std::uint16_t* port : {&server.udp, &server.tcp}) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const char* const end = text.data() + text.size();
    const auto [parsed, error] = std::from_chars(text.data() + colon + 1, end, *port);
    if (error != std::errc() || parsed != end || *port == 0) return std::nullopt;
    text = text.substr(0, colon);
  }
  if (text.empty()) return std::nullopt;
  server.host = text;
  return server;
}

}  // namespace furrow::client
