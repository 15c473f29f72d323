// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/session/hub.h"

namespace furrow::server {

// Follows one pose through the daemon: /api/trace.
class TraceApi {
 public:
  // `session`: of the daemon.
  explicit TraceApi(std::uint64_t session) : session_(session) {}

  // POST: follows the next pose of a subject. Replaces the trace before.
  [[nodiscard]] ApiReply Request(const ApiRequest& request, Hub& hub) const;
  // GET: the last trace, or what it waits for.
  [[nodiscard]] ApiReply Show(const ApiRequest& request, const Hub& hub, Time now) const;

 private:
  const std::uint64_t session_;
};

}  // namespace furrow::server
