// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/web_context.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"

namespace furrow::server {

// Serves one connection until it closes: answers HTTP requests one after the other, and hands the
// connection over if it becomes a WebSocket or a stream of pictures. `context` must outlive the
// coroutine, which runs on the web thread.
[[nodiscard]] net::awaitable<void> ServeConnection(WebStream stream, WebContext* context);

}  // namespace furrow::server
