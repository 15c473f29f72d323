// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/endpoint.h"

#include <charconv>
#include <cstdio>

#include "client/cli/common/exit_code.h"
#include "protocol/messages/limits.h"

namespace furrow::cli {
namespace {

// The clock's time in whole microseconds.
template <class Clock>
std::int64_t Microseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

}  // namespace

bool ParseEndpoint(const std::string& text, client::TransportKind kind, Endpoint* endpoint) {
  const bool tcp = kind == client::TransportKind::kTcp;
  endpoint->port = tcp ? protocol::kDefaultTcpPort : protocol::kDefaultUdpPort;
  std::string port;
  // Brackets separate the colons of an IPv6 address from that of the port (RFC 3986 section 3.2.2).
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string::npos) return false;
    endpoint->host = text.substr(1, close - 1);
    if (close + 1 < text.size()) {
      if (text[close + 1] != ':') return false;
      port = text.substr(close + 2);
      if (port.empty()) return false;
    }
  } else {
    const std::size_t colon = text.find(':');
    // Several colons without brackets are an IPv6 address without a port.
    const bool has_port =
        colon != std::string::npos && text.find(':', colon + 1) == std::string::npos;
    endpoint->host = has_port ? text.substr(0, colon) : text;
    if (has_port) {
      port = text.substr(colon + 1);
      if (port.empty()) return false;
    }
  }
  if (endpoint->host.empty()) return false;
  if (port.empty()) return true;
  const char* const end = port.data() + port.size();
  const auto [rest, error] = std::from_chars(port.data(), end, endpoint->port);
  return error == std::errc() && rest == end && endpoint->port != 0;
}

std::unique_ptr<client::Transport> OpenTransport(const std::string& host,
                                                 client::TransportKind kind, int* exit_code) {
  Endpoint endpoint;
  if (!ParseEndpoint(host, kind, &endpoint)) {
    std::fprintf(stderr, "furrow: '%s' is not HOST, HOST:PORT or [IPV6]:PORT\n", host.c_str());
    *exit_code = kUsage;
    return nullptr;
  }
  auto transport =
      client::Transport::Open(kind, endpoint.host, endpoint.port, std::chrono::milliseconds(3000));
  if (transport.ok()) return *std::move(transport);
  std::fprintf(stderr, "furrow: %s (is furrowd running there?)\n",
               transport.status().ToString().c_str());
  *exit_code = kNoConnection;
  return nullptr;
}

std::int64_t SteadyMicroseconds() { return Microseconds<std::chrono::steady_clock>(); }
std::int64_t SystemMicroseconds() { return Microseconds<std::chrono::system_clock>(); }

}  // namespace furrow::cli
