// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/beast.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// One connection, from the first byte to the last: requests one after the other, each answered, or
// handed on where it becomes a WebSocket or a stream of pictures.
[[nodiscard]] net::awaitable<void> ServeConnection(beast::tcp_stream stream, WebContext* context);

// One whole answer. False: the client is gone, or did not take it in time.
[[nodiscard]] net::awaitable<bool> WriteReply(beast::tcp_stream& stream, const WebRequest& request,
                                              ApiReply reply);

}  // namespace furrow::server
