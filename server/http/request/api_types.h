// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "base/status.h"
#include "server/http/request/url.h"

namespace furrow::server {

// A request and its answer, without the bytes of HTTP.
struct ApiRequest {
  std::string method;  // "GET", "PATCH"
  Url url;
  std::string body;
};

struct ApiReply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string file_name;  // offered for saving; empty: shown
  std::string allow;      // of 405: "GET, PATCH"
};

// {"error": {...}} of docs/HTTP-API.md. The overload takes HTTP's status from the code and the
// field from `where`.
[[nodiscard]] ApiReply ErrorReply(int status, std::string_view code, std::string_view field,
                                  std::string_view message, std::string_view hint = {});
[[nodiscard]] ApiReply ErrorReply(const Status& status);
// 405. `allow`: what `path` is asked with instead, "GET, HEAD".
[[nodiscard]] ApiReply MethodReply(std::string_view method, std::string_view path,
                                   std::string allow);

}  // namespace furrow::server
