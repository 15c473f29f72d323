// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/status.h"
#include "server/http/request/api_types.h"
#include "server/http/request/url.h"
#include "server/http/stream/beast.h"
#include "server/session/access/token_gate.h"

namespace furrow::server {

// What a request may do, by the token that it shows:
//
//   Authorization: Bearer frw1_...
//   Sec-WebSocket-Protocol: furrow.1, frw1_...   for browsers, which set no header on a WebSocket
//   ?token=frw1_...                              for <img> and links; removed from `url`
//
// `shielded`: nobody on the network can read the request. Without a token: TokenGate::Stranger().
// `gate` null: everything. Errors: those of TokenGate::Admit().
[[nodiscard]] Result<Access> AccessOf(const WebRequest& request, const TokenGate* gate,
                                      bool shielded, Url* url);

}  // namespace furrow::server
