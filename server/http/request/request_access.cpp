// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/request_access.h"

#include <string>

#include <boost/beast/http/rfc7230.hpp>

#include "base/ascii.h"
#include "protocol/secure/token/token_text.h"
#include "server/http/request/reply_writer.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr std::string_view kBearer = "Bearer ";

// The token of the request; empty if it shows none.
std::string TokenOf(const WebRequest& request, Url* url) {
  std::string token(url->Value("token"));
  std::erase_if(url->values, [](const auto& value) { return value.first == "token"; });
  const std::string_view header = ToView(request[http::field::authorization]);
  if (EqualsIgnoreCase(header.substr(0, kBearer.size()), kBearer)) {
    token = header.substr(kBearer.size());
  }
  for (const auto& offered : http::token_list(request[http::field::sec_websocket_protocol])) {
    if (ToView(offered).starts_with(protocol::secure::kTokenPrefix)) token = ToView(offered);
  }
  return token;
}

}  // namespace

Result<Access> AccessOf(const WebRequest& request, const TokenGate* gate, bool shielded, Url* url) {
  const std::string token = TokenOf(request, url);
  if (gate == nullptr) return Access::Everything();
  if (token.empty()) return gate->Stranger();
  return gate->Admit(token, shielded, ReadClock());
}

}  // namespace furrow::server
