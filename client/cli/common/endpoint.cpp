// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/endpoint.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include "client/cli/common/exit_code.h"
#include "client/cpp/reconnecting_transport.h"
#include "client/cpp/transports.h"

namespace furrow::cli {
bool ParseEndpoint(const std::string& text, client::TransportKind kind, Endpoint* endpoint) {
  const auto address = client::ParseAddress(text);
  if (!address.ok()) return false;
  const bool more = !address->subjects.empty() || !address->pattern.empty() ||
                    address->max_rate_hz != 0.0f || address->transport.value_or(kind) != kind;
  if (more) return false;
  *endpoint = {address->host, address->PortFor(kind), address->token};
  return true;
}

std::optional<client::Address> ParseHost(const std::string& text, const HostKeys& keys) {
  auto address = client::ParseAddress(text);
  if (!address.ok()) {
    std::fprintf(stderr, "furrow: %s\n", address.status().ToString().c_str());
    return std::nullopt;
  }
  if (!keys.token.empty()) {
    if (!address->token.empty()) {
      std::fprintf(stderr, "furrow: --token: the address states a token, too (use one of both)\n");
      return std::nullopt;
    }
    address->token = keys.token;
  }
  const char* unused = nullptr;
  if (!address->pattern.empty() && !keys.pattern) unused = "pattern";
  if (address->max_rate_hz != 0.0f && !keys.rate) unused = "rate";
  if (address->subjects.size() > 1 && !keys.several_subjects) unused = "a second subject";
  if (address->transport == client::TransportKind::kUdp && !keys.udp) unused = "transport=udp";
  if (unused == nullptr) return *std::move(address);
  std::fprintf(stderr, "furrow: address: this command has no use for %s (leave it out)\n", unused);
  return std::nullopt;
}

std::unique_ptr<client::Transport> OpenTransport(const client::Address& address,
                                                 client::TransportKind kind, bool once,
                                                 int* exit_code) {
  const std::uint16_t port = address.PortFor(kind);
  constexpr std::chrono::milliseconds kTimeout(3000);
  const auto token = client::LoadTokenOf(address);
  if (!token.ok()) {
    *exit_code = Fail(token.status().Within("token"));
    return nullptr;
  }
  const client::Token* const shown = *token ? &**token : nullptr;
  auto transport = client::OpenTransport(kind, address.host, port, kTimeout, shown);
  if (!transport.ok()) {
    const bool absent = transport.status().code() == StatusCode::kUnavailable;
    std::fprintf(stderr, "furrow: %s%s\n", transport.status().ToString().c_str(),
                 absent ? " (is furrowd running there?)" : "");
    *exit_code = absent ? kNoConnection : kFailed;
    return nullptr;
  }
  if (once) return *std::move(transport);
  return client::ReconnectingTransport::Create(kind, address.host, port, kTimeout,
                                               *std::move(transport), *token);
}

std::int64_t SystemMicroseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace furrow::cli
