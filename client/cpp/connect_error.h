// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <asio/error.hpp>
#include <asio/error_code.hpp>

#include "client/cpp/transport.h"

namespace furrow::client {

// The kUnavailable status of a look-up of a host or of a connect that failed.
[[nodiscard]] inline Status ConnectError(TransportKind kind, const std::string& host,
                                         std::uint16_t port, const asio::error_code& error) {
  const bool has_no_address = error == asio::error::host_not_found ||
                              error == asio::error::host_not_found_try_again ||
                              error == asio::error::no_data;
  return has_no_address ? HostNotFound(host) : ConnectionFailed(kind, host, port, error.message());
}

}  // namespace furrow::client
