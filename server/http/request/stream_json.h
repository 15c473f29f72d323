// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/time.h"
#include "server/http/request/json_reply.h"

namespace furrow::server {

// What every list of subjects says about a subject: its name, where it comes from, what its stream
// contains, how well its poses arrive, and its timecode (null: the source sends none).
[[nodiscard]] Json StreamJson(const Subject& subject, Hub& hub, Time now);

}  // namespace furrow::server
