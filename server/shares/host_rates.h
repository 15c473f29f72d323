// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "protocol/secure/session/host_budgets.h"
#include "server/core/time.h"

namespace furrow::server {

// At most `per_second` events per second of each host, of which `per_second` may come at once. The
// memory has a fixed size, whatever the number of hosts; see HostBudgets. Not thread-safe.
class HostRates {
 public:
  explicit HostRates(std::uint32_t per_second);

  // False, without effect, if the host has used up its rate. `host`: see HostOf(); hosts without a
  // numeric address share one rate.
  [[nodiscard]] bool Take(const std::string& host, Time now);

 private:
  protocol::secure::HostBudgets budgets_;
};

}  // namespace furrow::server
