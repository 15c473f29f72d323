// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/token_api.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/utc_time.h"
#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;

constexpr std::uint64_t kDefaultSeconds = 3600;

// The issuer checks the values against the token of the maker.
Result<TokenIssuer::Wanted> ParseWanted(const Json& object) {
  TokenIssuer::Wanted wanted;
  for (const auto& [name, value] : object.items()) {
    if (name != "roles" && name != "subjects" && name != "for") {
      return Status(StatusCode::kSchema, "must be one of roles, subjects, for", name);
    }
    if (!value.is_string()) return Status(StatusCode::kSchema, "must be a text", name);
    const std::string text = value.get<std::string>();
    if (name == "subjects") wanted.subjects = text;
    if (name == "roles") {
      const auto roles = secure::ParseRoles(text);
      if (!roles.ok()) return roles.status().At(name);
      wanted.roles = *roles;
    }
    if (name == "for") {
      const auto seconds = ParseDuration(text);
      if (!seconds) {
        return Status(StatusCode::kInvalidArgument, "is not a time", name, "for example 30m or 8h");
      }
      wanted.seconds = *seconds;
    }
  }
  if (!wanted.roles.valid()) {
    return Status(StatusCode::kSchema, "is missing", "roles", "for example \"publish,watch\"");
  }
  if (wanted.seconds == 0) {
    return Status(StatusCode::kSchema, "is missing", "for", "for example \"8h\"");
  }
  return wanted;
}

}  // namespace

ApiReply TokenRefusal(const Status& status) {
  switch (status.code()) {
    case StatusCode::kUnsupported:
      return ErrorReply(403, "forbidden", status.where(), status.what(), status.todo());
    case StatusCode::kLimit:
      return ErrorReply(429, "limit", status.where(), status.what(), status.todo());
    case StatusCode::kUnavailable:
      return ErrorReply(409, "conflict", status.where(), status.what(), status.todo());
    default: return ErrorReply(status);
  }
}

Status TokenApi::CheckWay(const ApiRequest& request) const {
  if (gate_ != nullptr && request.shielded) return {};
  return {StatusCode::kUnsupported,
          "tokens are made over HTTPS, or on the computer of the daemon only", "",
          "start the daemon with --tls-certificate"};
}

Result<std::string> TokenApi::MakeFor(const ApiRequest& request, const std::string& audience,
                                      const std::string& subject, Time now) {
  FURROW_RETURN_IF_ERROR(CheckWay(request));
  const auto roles = secure::ParseRoles(request.url.Value("roles"));
  if (!roles.ok()) return roles.status().At("roles");
  const std::string_view duration = request.url.Value("for");
  const auto seconds = duration.empty() ? std::optional(kDefaultSeconds) : ParseDuration(duration);
  if (!seconds || *seconds == 0) {
    return Status(StatusCode::kInvalidArgument, "is not a time", "for", "for example 30m or 8h");
  }
  // In a pattern, these letters would mean further subjects.
  if (subject.find_first_of("*?, ") != std::string::npos) {
    return Status(StatusCode::kInvalidArgument, "is a pattern, and a token is for one subject",
                  "subject");
  }
  const auto issued = issuer_.Issue(
      request.access,
      {.roles = *roles, .subjects = subject, .seconds = *seconds, .audience = audience}, now);
  FURROW_RETURN_IF_ERROR(issued);
  return issued->text;
}

ApiReply TokenApi::Make(const ApiRequest& request, Time now) {
  if (const Status way = CheckWay(request); !way.ok()) return TokenRefusal(way);
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  const auto wanted = ParseWanted(*object);
  if (!wanted.ok()) return ErrorReply(wanted.status());
  const auto issued = issuer_.Issue(request.access, *wanted, now);
  if (!issued.ok()) return TokenRefusal(issued.status());
  return JsonReply({{"token", issued->text},
                    {"expires", FormatUtc(issued->expires)},
                    {"roles", ToText(wanted->roles)},
                    {"subjects", issued->subjects}});
}

}  // namespace furrow::server
