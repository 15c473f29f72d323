// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/address.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/numbers.h"
#include "base/text.h"
#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "protocol/secure/token/token_text.h"

namespace furrow::client {
namespace {

constexpr std::string_view kScheme = "furrow://";
constexpr std::size_t kMaxAddressBytes = 64 * 1024;
constexpr std::size_t kMaxHostBytes = 255;
constexpr std::size_t kMaxSubjects = 256;
constexpr std::array<std::string_view, 10> kKeys = {
    "subject",       "pattern",         "rate",    "transport",     "token", "tls",
    "tls-authority", "tls-certificate", "tls-key", "token-in-clear"};
// A later version will use it. Ignoring it would pretend to protect.
constexpr std::string_view kReservedKey = "key";
constexpr std::size_t kMaxPathBytes = 4096;

Status Invalid(std::string what, std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), "address", std::move(todo)};
}

// Splits "HOST", "HOST:PORT" or "[IPV6]:PORT". `port` is empty if there is none, and `has_port`
// tells that from "HOST:".
bool SplitHost(std::string_view text, std::string_view* host, std::string_view* port,
               bool* has_port) {
  *port = {};
  *has_port = false;
  // Brackets separate the colons of an IPv6 address from that of the port (RFC 3986 section 3.2.2).
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) return false;
    *host = text.substr(1, close - 1);
    text.remove_prefix(close + 1);
    if (text.empty()) return true;
    if (text.front() != ':') return false;
  } else {
    const std::size_t colon = text.find(':');
    // Several colons without brackets are an IPv6 address without a port.
    const bool single =
        colon != std::string_view::npos && text.find(':', colon + 1) == std::string_view::npos;
    *host = single ? text.substr(0, colon) : text;
    if (!single) return true;
    text.remove_prefix(colon);
  }
  *has_port = true;
  *port = text.substr(1);
  return true;
}

Status ParseHost(std::string_view text, Address* address) {
  std::string_view host;
  std::string_view port;
  bool has_port = false;
  const char* const forms = "use HOST, HOST:PORT or [IPV6]:PORT, alone or after furrow://";
  if (!SplitHost(text, &host, &port, &has_port) || host.empty() || host.size() > kMaxHostBytes) {
    return Invalid(Quoted(text) + " names no host", forms);
  }
  const bool plain = std::ranges::all_of(host, [](unsigned char c) {
    return c > ' ' && c < 0x7f && std::string_view("/?#@[]\\\"'").find(c) == std::string_view::npos;
  });
  if (!plain) return Invalid(Quoted(host) + " is not a host name", forms);
  address->host = host;
  if (!has_port) return {};
  const auto [rest, error] = std::from_chars(port.data(), port.data() + port.size(), address->port);
  if (error != std::errc() || rest != port.data() + port.size() || address->port == 0) {
    return Invalid(Quoted(port) + " is not a port", "use a number from 1 to 65535");
  }
  return {};
}

Status SetTransport(const std::string& value, Address* address) {
  if (value == "shm") {
    return {StatusCode::kUnsupported, "transport=shm is reserved for a later version", "address",
            "use transport=udp or transport=tcp"};
  }
  if (value != "udp" && value != "tcp") {
    return Invalid("transport=" + Quoted(value) + " is unknown",
                   "use transport=udp or transport=tcp");
  }
  if (address->transport) return Invalid("transport is stated twice");
  address->transport = value == "udp" ? TransportKind::kUdp : TransportKind::kTcp;
  return {};
}

Status SetRate(const std::string& value, Address* address) {
  double rate = 0.0;
  if (!TryParseNumber(value, &rate) || !(rate > 0.0) || rate > protocol::kMaxRateHz) {
    return Invalid("rate=" + Quoted(value) + " is not a rate",
                   "use a number of frames per second above 0, at most 1000");
  }
  if (address->max_rate_hz != 0.0f) return Invalid("rate is stated twice");
  address->max_rate_hz = static_cast<float>(rate);
  return {};
}

Status SetToken(const std::string& value, Address* address) {
  if (value.empty() || value.size() > kMaxPathBytes || !protocol::IsPlainText(value)) {
    return Invalid("the token is not a file name and not a token",
                   "write token=FILE, with a file that 'furrow token new' made");
  }
  if (!address->token.empty()) return Invalid("token is stated twice");
  address->token = value;
  return {};
}

Status SetFlag(std::string_view key, const std::string& value, bool* flag) {
  if (value != "1") {
    return Invalid(std::string(key) + "=" + Quoted(value) + " is unknown",
                   "use " + std::string(key) + "=1, or leave it out");
  }
  *flag = true;
  return {};
}

Status SetFile(std::string_view key, const std::string& value, std::string* file) {
  if (value.empty() || value.size() > kMaxPathBytes || !protocol::IsPlainText(value)) {
    return Invalid(std::string(key) + "=" + Quoted(value) + " is not a file name",
                   "write " + std::string(key) + "=FILE, with a file in PEM form");
  }
  if (!file->empty()) return Invalid(std::string(key) + " is stated twice");
  *file = value;
  return {};
}

Status SetText(std::string_view key, const std::string& value, Address* address) {
  const bool subject = key == "subject";
  const auto most =
      static_cast<std::size_t>(subject ? protocol::kMaxNameBytes : protocol::kMaxPatternBytes);
  if (value.empty() || value.size() > most || !protocol::IsPlainText(value)) {
    return Invalid(
        std::string(key) + "=" + Quoted(value) + " is invalid",
        "use 1 to " + std::to_string(most) + " bytes of UTF-8 without control characters");
  }
  if (subject) {
    if (address->subjects.size() == kMaxSubjects) {
      return Invalid("too many subjects", "name at most " + std::to_string(kMaxSubjects));
    }
    address->subjects.push_back(value);
    return {};
  }
  if (!address->pattern.empty()) {
    return Invalid("pattern is stated twice", "separate several globs by commas");
  }
  address->pattern = value;
  return {};
}

Status SetValue(std::string_view item, Address* address) {
  const std::size_t equals = item.find('=');
  const std::string_view key = item.substr(0, equals);
  if (key == kReservedKey) {
    return {StatusCode::kUnsupported, std::string(key) + " is reserved for a later version",
            "address", "leave it out"};
  }
  if (std::ranges::find(kKeys, key) == kKeys.end()) {
    return Invalid("unknown key " + Quoted(key),
                   "use subject, pattern, rate, transport, token or tls");
  }
  std::optional<std::string> value;
  if (equals != std::string_view::npos) value = DecodePercent(item.substr(equals + 1));
  if (!value) {
    // A token must not end up in a log.
    return Invalid(Quoted(key == "token" ? key : item) + " is not a value",
                   "write " + std::string(key) + "=VALUE, and a percent sign as %25");
  }
  if (key == "token") return SetToken(*value, address);
  if (key == "transport") return SetTransport(*value, address);
  if (key == "rate") return SetRate(*value, address);
  if (key == "tls") return SetFlag(key, *value, &address->tls);
  if (key == "token-in-clear") return SetFlag(key, *value, &address->token_in_clear);
  if (key == "tls-authority") return SetFile(key, *value, &address->tls_files.authority);
  if (key == "tls-certificate") return SetFile(key, *value, &address->tls_files.certificate);
  if (key == "tls-key") return SetFile(key, *value, &address->tls_files.key);
  return SetText(key, *value, address);
}

Status ParseQuery(std::string_view query, Address* address) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    FURROW_RETURN_IF_ERROR(SetValue(query.substr(0, end), address));
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return {};
}

}  // namespace

std::uint16_t Address::PortFor(TransportKind kind) const {
  if (port != 0) return port;
  return kind == TransportKind::kTcp ? protocol::kDefaultTcpPort : protocol::kDefaultUdpPort;
}

Status Address::Complete() {
  tls |= !tls_files.authority.empty() || !tls_files.certificate.empty() || !tls_files.key.empty();
  if (!tls) return {};
  if (transport == TransportKind::kUdp) {
    return Invalid("TLS needs TCP", "use transport=tcp, or a token, which encrypts UDP");
  }
  if (tls_files.certificate.empty() && !tls_files.key.empty()) {
    return Invalid("tls-key needs tls-certificate", "state both");
  }
  transport = TransportKind::kTcp;
  return {};
}

Result<Address> ParseAddress(std::string_view text) {
  if (text.size() > kMaxAddressBytes) return Invalid("longer than 65536 bytes");
  Address address;
  if (!text.starts_with(kScheme)) {
    const std::size_t colon = text.find("://");
    if (colon != std::string_view::npos) {
      return Invalid("unknown scheme " + Quoted(text.substr(0, colon)), "use furrow://HOST");
    }
    FURROW_RETURN_IF_ERROR(ParseHost(text, &address));
    return address;
  }
  text.remove_prefix(kScheme.size());
  const std::size_t question = std::min(text.find('?'), text.size());
  std::string_view authority = text.substr(0, question);
  if (authority.ends_with('/')) authority.remove_suffix(1);
  FURROW_RETURN_IF_ERROR(ParseHost(authority, &address));
  if (question < text.size()) {
    FURROW_RETURN_IF_ERROR(ParseQuery(text.substr(question + 1), &address));
  }
  FURROW_RETURN_IF_ERROR(address.Complete());
  return address;
}

Result<std::optional<Token>> LoadTokenOf(const Address& address) {
  if (address.token.empty()) return std::optional<Token>();
  const bool is_text = address.token.starts_with(protocol::secure::kTokenPrefix);
  auto token = is_text ? protocol::secure::ParseToken(address.token)
                       : protocol::secure::LoadToken(address.token);
  FURROW_RETURN_IF_ERROR(token);
  return std::optional<Token>(*std::move(token));
}

Result<Security> LoadSecurityOf(const Address& address) {
  Security security{.token_in_clear = address.token_in_clear};
  auto token = LoadTokenOf(address);
  if (!token.ok()) return token.status().Within("token");
  security.token = *std::move(token);
  if (!address.tls) return security;
  auto tls = MakeTlsContext(address.tls_files);
  if (!tls.ok()) return tls.status().Within("tls");
  security.tls = *std::move(tls);
  security.own_authority = !address.tls_files.authority.empty();
  return security;
}

}  // namespace furrow::client
