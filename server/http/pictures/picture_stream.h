// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/request/url.h"
#include "server/http/request/web_context.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"

namespace furrow::server {

// Serves /mjpeg and /snapshot.png to clients that only speak HTTP: acts as a peer of the hub that
// subscribes to pictures, and acknowledges each picture after its bytes were sent. Arguments must
// outlive the coroutine, which runs on the web thread. `access`: what the client may do. False: the
// connection must close.
[[nodiscard]] net::awaitable<bool> ServePictures(WebStream* stream, WebContext* context,
                                                 const WebRequest& request, const Url& url,
                                                 const Access& access);

}  // namespace furrow::server
