// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/beast.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// Accepts the upgrade and carries messages between the client and the hub until one of them closes,
// or the client violates docs/HTTP-API.md.
[[nodiscard]] net::awaitable<void> ServeWebSocket(beast::tcp_stream stream, WebContext* context,
                                                  WebRequest request);

}  // namespace furrow::server
