// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"
#include "server/http/request/api_types.h"
#include "server/session/hub.h"

namespace furrow::server {

using Json = nlohmann::ordered_json;

// Returns a reply with status 200 and the document `json`. Invalid UTF-8 in it becomes replacement
// characters.
[[nodiscard]] ApiReply JsonReply(const Json& json);

// Parses the JSON object in the body of a request. Errors: kParse, kSchema; `where` is "body".
[[nodiscard]] Result<Json> ParseObject(const ApiRequest& request);

// Returns a reply with status 404 and a hint that lists the connected subjects that `access` is
// for. `name`: the requested subject; empty: any. Requires the hub's exclusive lock.
[[nodiscard]] ApiReply NoSuchSubject(const Hub& hub, std::string_view name, const Access& access);

}  // namespace furrow::server
