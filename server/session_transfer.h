// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "server/core/metrics.h"
#include "server/machine/service_manager.h"
#include "server/ports.h"
#include "server/restart/inheritance.h"
#include "server/session/hub.h"

namespace furrow::server {

// What has a part in the restart of a daemon. Not null, and outlive the calls.
struct TransferParts {
  Ports* ports = nullptr;
  Hub* hub = nullptr;
  Metrics* metrics = nullptr;
  ServiceManager* manager = nullptr;  // LeaveSessions() alone needs it
  std::uint64_t session = 0;          // number of the daemon's session
};

// Leaves sockets and sessions to the next daemon, after Ports::Leave(). `http`: the listening
// socket of the web server, if the next daemon needs it. False: it gets nothing, and the log says
// why; Ports::Drain() says goodbye.
[[nodiscard]] bool LeaveSessions(const TransferParts& parts, std::optional<int> http);

// Goes on with the sessions that the former daemon has left, and closes what is of no use.
void ResumeSessions(const TransferParts& parts, Inheritance* former);

}  // namespace furrow::server
