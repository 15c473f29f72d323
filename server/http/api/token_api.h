// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
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
  // Makes the token that ?roles= and &for= (default: 1h) describe, for one subject at one server.
  [[nodiscard]] Result<std::string> MakeFor(const ApiRequest& request, const std::string& audience,
                                            const std::string& subject, Time now);

 private:
  [[nodiscard]] Status CheckWay(const ApiRequest& request) const;

  const TokenGate* const gate_;
  TokenIssuer issuer_;
};

// The reply to a request for a token that was refused.
[[nodiscard]] ApiReply TokenRefusal(const Status& status);

}  // namespace furrow::server
