// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/json_reply.h"

#include <string>

#include <nlohmann/json.hpp>

namespace furrow::server {

ApiReply JsonReply(const Json& json) {
  // Names come from senders. dump() would throw on bytes that are not UTF-8.
  return {.body = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Result<Json> ParseObject(const ApiRequest& request) {
  // No request needs this depth, and copying a document recurses once per level.
  constexpr int kMaxDepth = 8;
  bool is_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
    is_deep = is_deep || depth > kMaxDepth;
    // The parser drops what is below this depth instead of storing it.
    return !is_deep;
  };
  Json json = Json::parse(request.body, keep, /*allow_exceptions=*/false);
  if (is_deep) {
    return Status(StatusCode::kSchema,
                  "the body is nested deeper than " + std::to_string(kMaxDepth) + " levels",
                  "body");
  }
  if (json.is_discarded()) return Status(StatusCode::kParse, "the body is not valid JSON", "body");
  if (!json.is_object()) {
    return Status(StatusCode::kSchema, "the body must be a JSON object", "body");
  }
  return json;
}

ApiReply NoSuchSubject(const Hub& hub, std::string_view name, const Access& access) {
  const std::string known = hub.subjects().Names(access);
  return ErrorReply(404, "not_found", "subject",
                    name.empty() ? "there is no subject" : "no subject '" + std::string(name) + "'",
                    known.empty() ? "no subject is connected" : "connected subjects: " + known);
}

}  // namespace furrow::server
