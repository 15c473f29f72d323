// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/beast.h"
#include "server/http/request/url.h"
#include "server/http/request/web_context.h"

namespace furrow::server {

// /mjpeg and /snapshot.png: a peer of the hub that asks for pictures on behalf of a client that
// speaks nothing but HTTP, and acknowledges each when its bytes have left. False: the connection
// ends here.
[[nodiscard]] net::awaitable<bool> ServePictures(beast::tcp_stream* stream, WebContext* context,
                                                 const WebRequest& request, const Url& url);

}  // namespace furrow::server
