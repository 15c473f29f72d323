// SPDX-License-Identifier: Apache-2.0
#include "server/http/metrics/metric_families.h"

#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <malloc.h>

#include "server/machine/process_stats.h"
#include "server/net/clock.h"

namespace furrow::server {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

namespace {

MetricFamily Empty(std::string_view name, std::string_view help, MetricType type) {
  MetricFamily family;
  family.name = name;
  family.help = help;
  family.type = type;
  return family;
}

ClientMetric::Histogram HistogramOf(const Timings::Sum& sum) {
  ClientMetric::Histogram histogram;
  histogram.sample_sum = sum.seconds;
  for (std::size_t i = 0; i < Timings::kBuckets; ++i) {
    histogram.sample_count += sum.counts[i];
    const double bound =
        i < Timings::kBounds.size() ? Timings::kBounds[i] : std::numeric_limits<double>::infinity();
    histogram.bucket.push_back({histogram.sample_count, bound});
  }
  return histogram;
}

}  // namespace

MetricFamily Family(std::string_view name, std::string_view help, MetricType type, double value) {
  MetricFamily family = Empty(name, help, type);
  ClientMetric metric;
  (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  family.metric.push_back(std::move(metric));
  return family;
}

// Counters are read one by one while other threads add; each is right, but they are not from one
// moment.
void AddCounters(const Metrics& metrics, std::vector<MetricFamily>* families) {
  for (int i = 0; i < static_cast<int>(Counter::kCount); ++i) {
    const auto counter = static_cast<Counter>(i);
    families->push_back(Family(CounterName(counter), CounterHelp(counter), MetricType::Counter,
                               static_cast<double>(metrics.Get(counter))));
  }
}

void AddTimings(const Timings& timings, std::vector<MetricFamily>* families) {
  for (int i = 0; i < static_cast<int>(Timing::kCount); ++i) {
    const auto timing = static_cast<Timing>(i);
    const TimingInfo& info = InfoOf(timing);
    // Stages of one family follow each other.
    if (families->empty() || families->back().name != info.name) {
      families->push_back(Empty(info.name, info.help, MetricType::Histogram));
    }
    ClientMetric metric;
    metric.histogram = HistogramOf(timings.Get(timing));
    if (!info.stage.empty()) metric.label.push_back({"stage", std::string(info.stage)});
    families->back().metric.push_back(std::move(metric));
  }
}

// Seconds since 1970. Always the same number, because a change of it means a restart.
double StartTime(double uptime) {
  static const double start = static_cast<double>(UnixSeconds()) - uptime;
  return start;
}

// The names without "furrow_" are those of Prometheus' client libraries.
void AddProcess(double uptime, std::vector<MetricFamily>* families) {
  families->push_back(Family("furrow_build_info", "Always 1; the labels say what was built.",
                             MetricType::Gauge, 1.0));
  families->back().metric.front().label = {{"version", FURROW_VERSION}, {"compiler", __VERSION__}};
  const ProcessStats stats = ReadProcessStats();
  families->push_back(Family("process_cpu_seconds_total",
                             "Processor time of the daemon, user and system, in seconds.",
                             MetricType::Counter, stats.cpu_seconds));
  const auto add = [families](std::string_view name, std::string_view help, auto value) {
    families->push_back(Family(name, help, MetricType::Gauge, static_cast<double>(value)));
  };
  add("process_start_time_seconds", "Start of the daemon, in seconds since 1970.",
      StartTime(uptime));
  add("process_resident_memory_bytes", "Memory of the daemon in RAM.", stats.resident_bytes);
  add("process_virtual_memory_bytes", "Address space of the daemon.", stats.virtual_bytes);
  add("process_threads", "Threads of the daemon.", stats.threads);
  add("process_open_fds", "Open files and sockets of the daemon.", stats.open_files);
  add("process_max_fds", "Most files and sockets that the daemon may open.", stats.max_files);
  // What the process holds beyond its needs is the allocator's: peaks of the past, and gaps.
  const struct mallinfo2 heap = mallinfo2();
  add("furrow_heap_used_bytes", "Allocated memory in use.", heap.uordblks + heap.hblkhd);
  add("furrow_heap_bytes", "Memory that the allocator has taken from the system.",
      heap.arena + heap.hblkhd);
}

}  // namespace furrow::server
