// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "server/http/request/url.h"

namespace furrow::server {

// Returns the subscriptions that the query of /weights asks for, one per subject (default: the
// oldest subject). Keys: `subject` (repeatable), `pattern`, `rate` (frames per second in
// [0, 1000]; 0: every pose), `every` (true or false; see protocol::SubscribeWeights). Errors:
// kInvalidArgument, with the key as `where`.
[[nodiscard]] Result<std::vector<protocol::SubscribeWeights>> WeightsOf(const Url& url);

}  // namespace furrow::server
