// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "server/core/network_address.h"

namespace furrow::server {

// The failure to listen on `where`: what is wrong, and the way out. `transport`: "TCP" or "UDP".
// `error`: the number of the system (errno). `flag`: sets the port, such as "--tcp". Code:
// kUnavailable.
[[nodiscard]] Status ListenError(const std::string& transport, const HostPort& where, int error,
                                 const std::string& flag);

}  // namespace furrow::server
