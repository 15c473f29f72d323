// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/cpp/tls/security.h"
#include "client/load/measure/checker.h"
#include "client/load/measure/histogram.h"
#include "client/load/measure/process_usage.h"
#include "client/load/run/misbehaving_subscribers.h"
#include "client/load/schedule/plan.h"
#include "client/load/schedule/workload.h"

namespace furrow::load {

// Transport of poses and weights. kBoth: half of the sockets use UDP and half use TCP.
enum class Path { kUdp, kTcp, kBoth };

// The server to measure.
struct Target {
  std::string host;
  std::uint16_t udp = 0;
  std::uint16_t tcp = 0;
  bool echo = false;             // a raw echo, which returns the poses themselves
  bool loopback = true;          // `host` is a loopback address
  client::Security security;     // of every socket
  std::string certificate_host;  // TLS: whom the certificate is for; empty: `host`
  std::optional<int> pid;        // process of the server, if it is known and on this machine
};

// The options of a run.
struct RunOptions {
  Path path = Path::kUdp;
  PlanOptions plan;
  std::uint32_t first = 0;  // the number in the name of the first subject
  int watchers = 1;         // each receives all subjects
  MisbehaviorOptions misbehavior;
  std::int64_t late_us = 16'667;  // latency limit, microseconds: one frame at 60 Hz
  float tolerance = 1e-4f;        // largest accepted difference of a weight
  double drain_seconds = 1.0;     // after this time without weights the missing ones count as lost
  bool check_weights = true;
  bool redundant = false;  // over UDP, poses repeat the previous one where there is room
};

// Callbacks during a run. All of them must be set.
struct RunHooks {
  std::function<bool()> keep_going;             // returning false stops the run early
  std::function<void(double share)> solving;    // progress in [0, 1] before the start
  std::function<void(double share)> resolving;  // progress in [0, 1] of ResolveMismatches()
  std::function<void(double seconds, const Tally&, const Histogram& latency_ns)>
      second;  // called once per second of the run
};

// The measurements of a run.
struct RunResult {
  Tally tally;
  Histogram latency_ns;            // from the due time of a pose to net::Socket::arrived_ns()
  std::vector<Histogram> windows;  // latency in equal parts of `planned_seconds`
  Histogram send_delay_ns;         // from the due time of a pose to its send
  double seconds = 0.0;            // actual length, up to an interrupt
  double planned_seconds = 0.0;
  double planned_rate = 0.0;          // poses per second
  std::optional<double> cpu_seconds;  // of the target's process during the run
  std::optional<ProcessUsage> usage;  // at the end of the run
  bool usage_unknown = false;         // the server is on this machine and its process is unknown
  std::uint64_t overrun = 0;          // datagrams lost in the generator's own buffers
  std::uint64_t malformed = 0;        // messages that could not be decoded
  std::uint64_t churn_returns = 0;
  std::uint64_t subscribers_cut = 0;  // MisbehavingSubscribers::cut()
  bool checked_names = false;         // the weight names of daemon and solver are equal
  std::string complaint;              // the daemon's last error, or the reason of an early end
  bool interrupted = false;           // stopped by the caller
  bool ended_early = false;           // the daemon went away; `complaint` says how

  // The latency at `percentile` (in [0, 100]), microseconds.
  [[nodiscard]] double p(double percentile) const {
    return static_cast<double>(latency_ns.Percentile(percentile)) * 1e-3;
  }
  // The target's processor time per sent pose, in microseconds.
  [[nodiscard]] std::optional<double> cpu_us_per_pose() const;
};

// Runs one load test on one thread: offers the subjects, subscribes, sends each pose when it is
// due, receives weights, waits for the remaining ones and checks them.
//
// Over UDP nothing delays the next pose. Over TCP a daemon that does not read blocks all poses, for
// 5 seconds at most; send_delay_ns then shows the delay. A misbehaving subscriber that connects
// again blocks for one round trip.
//
// Errors: kUnavailable (no answer), kInvalidArgument (rejected by the daemon, with the reason).
[[nodiscard]] Result<RunResult> Run(const Workload& workload, const Target& target,
                                    const RunOptions& options, const RunHooks& hooks);

}  // namespace furrow::load
