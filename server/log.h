// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config.h"

namespace furrow::server {

// Sends the program's log to stderr, a line a message: for people, or (--log-json) one JSON object
// a line with "time", "level" and "message".
void SetUpLog(const Config& config);

}  // namespace furrow::server
