// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/cpp/address.h"
#include "client/cpp/clock.h"
#include "client/cpp/transport.h"

namespace furrow::cli {

// The flags that state what the keys token, tls, tls-... and token-in-clear of an address do.
struct SecurityFlags {
  std::string token;
  bool tls = false;
  client::ClientTlsFiles tls_files;
  bool token_in_clear = false;
};

// The keys of an address that a command can use, besides those of SecurityFlags, one subject and
// transport=tcp.
struct HostKeys {
  bool several_subjects = false;
  bool pattern = false;
  bool rate = false;
  bool udp = false;
  SecurityFlags security = {};
};

// Parses a HOST argument. Prints the error and returns nothing if the text is invalid, or if it
// states something that the command cannot use.
[[nodiscard]] std::optional<client::Address> ParseHost(const std::string& text,
                                                       const HostKeys& keys);

// The transport that the flags --udp and --tcp choose, or else the address. Without either, a token
// goes over UDP, where it is safe, and all else over TCP.
[[nodiscard]] client::TransportKind ChooseTransport(bool udp, bool tcp,
                                                    const client::Address& address);

// Connects to a daemon within 3 seconds, with the token and the TLS of the address. Later losses
// are repaired by the transport, unless `once`. On failure prints the error, sets `exit_code` and
// returns null; on success leaves `exit_code` unchanged.
[[nodiscard]] std::unique_ptr<client::Transport> OpenTransport(const client::Address& address,
                                                               client::TransportKind kind,
                                                               bool once, int* exit_code);

using client::SteadyMicroseconds;
// The time of the system clock, microseconds since 1970 (UTC).
[[nodiscard]] std::int64_t SystemMicroseconds();

}  // namespace furrow::cli
