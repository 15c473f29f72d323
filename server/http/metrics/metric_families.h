// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <prometheus/metric_family.h>

#include "server/core/metrics.h"
#include "server/core/timings.h"

// The metrics of a daemon as families of Prometheus. None has labels for subjects or peers, which
// would let senders create series without end.
namespace furrow::server {

// A family with one metric and no labels. `type`: Counter or Gauge.
[[nodiscard]] prometheus::MetricFamily Family(std::string_view name, std::string_view help,
                                              prometheus::MetricType type, double value);

void AddCounters(const Metrics& metrics, std::vector<prometheus::MetricFamily>* families);
void AddTimings(const Timings& timings, std::vector<prometheus::MetricFamily>* families);
// The build, and the resources of the process. `uptime`: seconds since the start.
void AddProcess(double uptime, std::vector<prometheus::MetricFamily>* families);

}  // namespace furrow::server
