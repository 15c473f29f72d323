// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/session/access/token_issuer.h"

namespace furrow::server {

// Makes tokens: POST /api/token.
class TokenApi {
 public:
  // `gate`: null: the daemon has no tokens. `metrics`: not null.
  TokenApi(const TokenGate* gate, Metrics* metrics) : gate_(gate), issuer_(gate, metrics) {}

  // Makes the token that the body describes.
  [[nodiscard]] ApiReply Make(const ApiRequest& request, Time now);

 private:
  const TokenGate* const gate_;
  TokenIssuer issuer_;
};

}  // namespace furrow::server
