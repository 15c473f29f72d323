// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "server/cluster/coordinator.h"
#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/http/request/url.h"
#include "server/session/access/access.h"

namespace furrow::server {

// The reply that sends a client to the node that serves the subject of its request: 307 with the
// same path and query there. Nothing: this daemon answers, because it serves the subject, or nobody
// does; because the request names no subject, or several; because the client may not watch it;
// because the node has no web server; or because it speaks HTTP and the request came over HTTPS.
//
// The location never holds a token: whoever may write to the store of the cluster decides where it
// leads. `cluster`: null: the daemon is alone.
[[nodiscard]] std::optional<ApiReply> SendElsewhere(const Coordinator* cluster, const Url& url,
                                                    const Access& access, bool is_https, Time now);

}  // namespace furrow::server
