// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/api_types.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace furrow::server {
namespace {

struct CodeInfo {
  int status;
  std::string_view name;
};

// HTTP status and error name for a code. Names are part of docs/HTTP-API.md.
CodeInfo InfoOf(StatusCode code) {
  switch (code) {
    case StatusCode::kOk: return {200, "ok"};
    case StatusCode::kNotFound: return {404, "not_found"};
    case StatusCode::kParse: return {400, "parse"};
    case StatusCode::kSchema: return {400, "schema"};
    case StatusCode::kUnavailable: return {503, "unavailable"};
    case StatusCode::kIo:
    case StatusCode::kInternal: return {500, "internal"};
    default: return {400, "invalid_argument"};
  }
}

}  // namespace

std::string JsonText(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ApiReply ErrorReply(int status, std::string_view code, std::string_view field,
                    std::string_view message, std::string_view hint) {
  // Not by a document, whose destructor allocates: memory may be short.
  return {.status = status,
          .body = R"({"error":{"code":)" + JsonText(code) + R"(,"field":)" + JsonText(field) +
                  R"(,"message":)" + JsonText(message) + R"(,"hint":)" + JsonText(hint) + "}}"};
}

ApiReply ErrorReply(const Status& status) {
  const CodeInfo info = InfoOf(status.code());
  return ErrorReply(info.status, info.name, status.where(), status.what(), status.todo());
}

ApiReply NotOfferedReply(std::string_view message) {
  ApiReply reply = ErrorReply(503, "unavailable", "", message);
  reply.retry_after = 0;
  return reply;
}

ApiReply NeedsRole(std::string_view role, std::string_view path, const Access& access) {
  return ErrorReply(
      403, "forbidden", "",
      std::string(path) + " needs the role " + std::string(role) + "; " + access.Text(),
      "use a token with this role");
}

ApiReply MethodReply(std::string_view method, std::string_view path, std::string allow) {
  ApiReply reply =
      ErrorReply(405, "method", "", std::string(path) + " does not support " + std::string(method),
                 "use " + allow);
  reply.allow = std::move(allow);
  return reply;
}

ApiReply NeedsToken(std::string_view why) {
  return ErrorReply(401, "needs_token", "", why,
                    "send the header Authorization: Bearer TOKEN, or ?token=TOKEN");
}

ApiReply RefusesToken(std::string_view why) {
  ApiReply reply = NeedsToken(why);
  reply.bad_token = true;
  return reply;
}

}  // namespace furrow::server
