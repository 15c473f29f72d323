// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/web_context.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"
#include "server/http/weights/weight_query.h"

namespace furrow::server {

// Streams weights as JSON objects (WeightLines) until the client or the daemon ends: as peers of
// the hub that subscribe as `query` says. After `query.alive` without a line, the client receives
// WeightLines::kAlive. A client that has vanished without closing, and so confirms nothing, is
// disconnected after kWebDeadline. `context` must outlive the coroutines, which run on the web
// thread. `access`: what the client may do.

// Accepts the WebSocket upgrade in `request` and sends each object as a text message. Messages from
// the client are ignored.
[[nodiscard]] net::awaitable<void> ServeWeightSocket(WebStream stream, WebContext* context,
                                                     WebRequest request, WeightQuery query,
                                                     Access access);

// Answers a plain GET with one object per line, for clients without WebSockets. The arguments must
// outlive the coroutine.
[[nodiscard]] net::awaitable<void> ServeWeightLines(WebStream* stream, WebContext* context,
                                                    WeightQuery query, Access access);

}  // namespace furrow::server
