// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/beast.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// Takes the upgrade and carries messages of the wire between the client and the hub until either
// ends it, or the client breaks the rules of docs/HTTP-API.md.
[[nodiscard]] net::awaitable<void> ServeWebSocket(beast::tcp_stream stream, WebContext* context,
                                                  WebRequest request);

}  // namespace furrow::server
