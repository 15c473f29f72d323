// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "client/cpp/tls/client_tls.h"
#include "client/cpp/tls/security.h"
#include "client/cpp/transport.h"

namespace furrow::client {

// The address of a daemon, and what to ask of it:
//
//   furrow://host[:port][?subject=ada&rate=60&pattern=brow_*&transport=udp]
//   HOST, HOST:PORT or [IPV6]:PORT, which state no more than the daemon
//
// Keys of the query, each at most once unless stated otherwise:
//   subject    who to follow (repeatable); without it, the oldest live subject
//   pattern    names of values, as comma-separated globs
//   rate       most frames per second, in (0, 1000]
//   transport  udp or tcp
//   token      a file with a connect token, or the token itself (docs/TOKENS.md)
//   tls        1: TLS over TCP (docs/SECURITY.md)
//   tls-authority               a file with the authorities that the daemon's certificate is
//                               checked with, or that certificate itself; implies tls=1
//   tls-certificate, tls-key    files with the client's own certificate and key; implies tls=1
//   token-in-clear              1: permits the token over plain TCP to other computers
// `%2A` stands for the byte with this hexadecimal number, in values.
struct Address {
  std::string host;                        // a name or a numeric address, without brackets
  std::uint16_t port = 0;                  // 0: not stated
  std::optional<TransportKind> transport;  // nothing: not stated
  std::vector<std::string> subjects;
  std::string pattern;       // empty: not stated
  float max_rate_hz = 0.0f;  // 0: not stated
  std::string token;         // a file, or the text of a token; empty: not stated
  bool tls = false;
  ClientTlsFiles tls_files;  // of TLS
  bool token_in_clear = false;

  // The stated port, or the protocol's port for `kind`.
  [[nodiscard]] std::uint16_t PortFor(TransportKind kind) const;
  // Completes what the values imply: tls=1 by the files of TLS, and TCP by tls=1. Errors:
  // kInvalidArgument (UDP with TLS). ParseAddress() calls it.
  [[nodiscard]] Status Complete();
};

// Parses an address. The result is checked as the daemon would check it.
//
// Errors: kInvalidArgument (not an address, an unknown key, or a value outside its range);
// kUnsupported (the key key, and transport=shm: reserved for later versions). Messages
// never repeat a token.
[[nodiscard]] Result<Address> ParseAddress(std::string_view text);

// Reads what Address::token names; nothing if it is empty. Errors: those of
// protocol::secure::LoadToken() and ParseToken().
[[nodiscard]] Result<std::optional<Token>> LoadTokenOf(const Address& address);
// The same, with TLS. Errors: also those of MakeTlsContext().
[[nodiscard]] Result<Security> LoadSecurityOf(const Address& address);

}  // namespace furrow::client
