// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "protocol/messages/messages.h"
#include "server/http/request/beast.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// Streams weights as JSON objects (WeightLines) until the client or the daemon ends: as peers of
// the hub that subscribe with `requests`. `context` must outlive the coroutines, which run on the
// web thread.

// Accepts the WebSocket upgrade in `request` and sends each object as a text message. Messages from
// the client are ignored.
[[nodiscard]] net::awaitable<void> ServeWeightSocket(
    beast::tcp_stream stream, WebContext* context, WebRequest request,
    std::vector<protocol::SubscribeWeights> requests);

// Answers a plain GET with one object per line, for clients without WebSockets. The arguments must
// outlive the coroutine.
[[nodiscard]] net::awaitable<void> ServeWeightLines(
    beast::tcp_stream* stream, WebContext* context,
    std::vector<protocol::SubscribeWeights> requests);

}  // namespace furrow::server
