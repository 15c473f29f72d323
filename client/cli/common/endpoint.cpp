// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/endpoint.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include "client/cli/common/exit_code.h"
#include "client/cpp/reconnecting_transport.h"
#include "client/cpp/tls/client_tls.h"
#include "client/cpp/transports.h"

namespace furrow::cli {
namespace {

// Takes over a value that the address must not state, too.
Status TakeOver(const char* flag, const std::string& value, std::string* target) {
  if (value.empty()) return {};
  if (!target->empty()) {
    return {StatusCode::kInvalidArgument, "the address states it, too", flag, "use one of both"};
  }
  *target = value;
  return {};
}

Status TakeOver(const SecurityFlags& flags, client::Address* address) {
  client::ClientTlsFiles& files = address->tls_files;
  FURROW_RETURN_IF_ERROR(TakeOver("--token", flags.token, &address->token));
  FURROW_RETURN_IF_ERROR(TakeOver("--tls-authority", flags.tls_files.authority, &files.authority));
  FURROW_RETURN_IF_ERROR(
      TakeOver("--tls-certificate", flags.tls_files.certificate, &files.certificate));
  FURROW_RETURN_IF_ERROR(TakeOver("--tls-key", flags.tls_files.key, &files.key));
  address->tls |= flags.tls;
  address->token_in_clear |= flags.token_in_clear;
  return address->Complete();
}

}  // namespace

std::optional<client::Address> ParseHost(const std::string& text, const HostKeys& keys) {
  auto address = client::ParseAddress(text);
  if (!address.ok()) {
    std::fprintf(stderr, "furrow: %s\n", address.status().ToString().c_str());
    return std::nullopt;
  }
  if (const Status status = TakeOver(keys.security, &*address); !status.ok()) {
    std::fprintf(stderr, "furrow: %s\n", status.ToString().c_str());
    return std::nullopt;
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

client::TransportKind ChooseTransport(bool udp, bool tcp, const client::Address& address) {
  if (udp) return client::TransportKind::kUdp;
  if (tcp) return client::TransportKind::kTcp;
  return address.transport.value_or(address.token.empty() ? client::TransportKind::kTcp
                                                          : client::TransportKind::kUdp);
}

std::unique_ptr<client::Transport> OpenTransport(const client::Address& address,
                                                 client::TransportKind kind, bool once,
                                                 int* exit_code) {
  const std::uint16_t port = address.PortFor(kind);
  constexpr std::chrono::milliseconds kTimeout(3000);
  const auto connect_timeout = address.tls ? client::kTlsConnectTimeout : kTimeout;
  if (address.tls && kind == client::TransportKind::kUdp) {
    std::fprintf(stderr, "furrow: --udp: TLS needs TCP (over UDP, a token encrypts)\n");
    *exit_code = kUsage;
    return nullptr;
  }
  const auto security = client::LoadSecurityOf(address);
  if (!security.ok()) {
    *exit_code = Fail(security.status());
    return nullptr;
  }
  auto transport = client::OpenTransport(kind, address.host, port, connect_timeout, *security);
  if (!transport.ok()) {
    const bool absent = transport.status().code() == StatusCode::kUnavailable;
    const bool needs_hint = absent && transport.status().todo().empty();
    std::fprintf(stderr, "furrow: %s%s\n", transport.status().ToString().c_str(),
                 needs_hint ? " (is furrowd running there?)" : "");
    *exit_code = absent ? kNoConnection : kFailed;
    return nullptr;
  }
  if (once) return *std::move(transport);
  return client::ReconnectingTransport::Create(kind, address.host, port, kTimeout,
                                               *std::move(transport), *security);
}

std::int64_t SystemMicroseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace furrow::cli
