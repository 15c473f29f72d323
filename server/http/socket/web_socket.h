// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/web_context.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"

namespace furrow::server {

// Accepts the WebSocket upgrade in `request` and carries messages between the client and the hub
// until one of them closes, or the client violates the protocol. `context` must outlive the
// coroutine, which runs on the web thread. `access`: what the client may do.
[[nodiscard]] net::awaitable<void> ServeWebSocket(WebStream stream, WebContext* context,
                                                  WebRequest request, Access access);

}  // namespace furrow::server
