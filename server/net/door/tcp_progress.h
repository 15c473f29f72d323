// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/tls/stranger_patience.h"

namespace furrow::server {

// What the kernel knows of the client at the other end of a TCP connection; zeros if it does not
// know.
[[nodiscard]] StrangerPatience::Client ReadTcpProgress(int socket);

}  // namespace furrow::server
