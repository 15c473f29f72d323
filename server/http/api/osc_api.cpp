// SPDX-License-Identifier: Apache-2.0
#include "server/http/api/osc_api.h"

#include <string>

#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "server/config/osc_profile_file.h"
#include "server/http/request/json_reply.h"

namespace furrow::server {
namespace {

// Foreign addresses and targets of the configuration are forbidden, not invalid.
ApiReply Refusal(const Status& status) {
  if (status.code() == StatusCode::kUnsupported) {
    return ErrorReply(403, "forbidden", status.where(), status.what(), status.todo());
  }
  if (status.code() == StatusCode::kLimit) {
    return ErrorReply(409, "conflict", status.where(), status.what(), status.todo());
  }
  return ErrorReply(status);
}

// Stores a text member.
Status ReadText(const Json& value, const std::string& name, std::string* target) {
  if (!value.is_string()) return Status(StatusCode::kSchema, "must be a text", name);
  *target = value.get<std::string>();
  return {};
}

// OscControl checks the values. Unknown names are errors, because a misspelt one would silently do
// nothing.
Result<OscTargetConfig> ParseTarget(const Json& object) {
  OscTargetConfig target;
  for (const auto& [name, value] : object.items()) {
    Status status;
    if (name == "to") {
      std::string text;
      status = ReadText(value, name, &text);
      if (status.ok()) {
        const Result<HostPort> to = ParseHostPort(text);
        if (!to.ok()) return to.status().At(name);
        target.to = *to;
      }
    } else if (name == "profile") {
      status = ReadText(value, name, &target.profile);
    } else if (name == "prefix") {
      status = ReadText(value, name, &target.prefix);
    } else if (name == "subject") {
      status = ReadText(value, name, &target.subject);
    } else if (name == "pattern") {
      status = ReadText(value, name, &target.pattern);
    } else if (name == "rate_hz") {
      if (!value.is_number()) return Status(StatusCode::kSchema, "must be a number", name);
      target.rate_hz = value.get<double>();
    } else {
      status = Status(StatusCode::kSchema,
                      "must be one of to, profile, prefix, subject, pattern, rate_hz", name);
    }
    FURROW_RETURN_IF_ERROR(status);
  }
  if (target.to.port == 0) {
    return Status(StatusCode::kSchema, "is missing", "to", "for example 127.0.0.1:9000");
  }
  return target;
}

}  // namespace

ApiReply OscApi::List() const {
  Json targets = Json::array();
  for (const OscControl::View& view : targets_->List()) {
    targets.push_back({{"id", view.id},
                       {"to", HostPortText(view.config.to)},
                       {"profile", view.config.profile},
                       {"prefix", view.config.prefix},
                       {"subject", view.config.subject},
                       {"pattern", view.config.pattern},
                       {"rate_hz", view.config.rate_hz},
                       {"configured", view.configured},
                       {"packets", view.packets},
                       {"errors", view.errors},
                       {"last_error", view.last_error}});
  }
  return JsonReply({{"targets", std::move(targets)},
                    {"profiles", ShippedOscProfiles()},
                    {"allow", targets_->allowed()}});
}

ApiReply OscApi::Add(const ApiRequest& request) {
  const Result<Json> object = ParseObject(request);
  if (!object.ok()) return ErrorReply(object.status());
  const Result<OscTargetConfig> target = ParseTarget(*object);
  if (!target.ok()) return ErrorReply(target.status());
  const Result<int> id = targets_->Add(*target);
  return id.ok() ? List() : Refusal(id.status());
}

ApiReply OscApi::Remove(const ApiRequest& request) {
  const std::string id(request.url.Value("id"));
  const std::optional<long> number = ToInteger(id);
  if (!number || *number < 1 || *number > 1'000'000'000) {
    return ErrorReply(400, "invalid_argument", "id", "'" + id + "' is not the number of a target",
                      "GET /api/osc lists the targets");
  }
  const Status status = targets_->Remove(static_cast<int>(*number));
  return status.ok() ? List() : Refusal(status);
}

}  // namespace furrow::server
