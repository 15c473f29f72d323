// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/load/burdens.h"
#include "client/load/measure/checker.h"
#include "client/load/measure/histogram.h"
#include "client/load/measure/process_usage.h"
#include "client/load/schedule/performance.h"
#include "client/load/schedule/plan.h"

namespace furrow::load {

// Over what poses leave and weights come: half of the sockets each way with kBoth.
enum class Path { kUdp, kTcp, kBoth };

// Who is measured.
struct Target {
  std::string host;
  std::uint16_t udp = 0;
  std::uint16_t tcp = 0;
  bool echo = false;       // sends every datagram back: poses themselves are what returns
  bool loopback = true;    // by this machine's loopback address
  std::optional<int> pid;  // of its process, where it is on this machine
};

struct RunOptions {
  Path path = Path::kUdp;
  PlanOptions plan;
  int watchers = 1;  // each of all subjects
  BurdenOptions burdens;
  std::int64_t late_us = 16'667;  // beyond it weights are late: a frame at 60 Hz
  float tolerance = 1e-4f;
  double drain_seconds = 1.0;  // after so long without weights what is missing is lost
  bool check_weights = true;
};

// What the caller hears while a run lasts.
struct RunHooks {
  std::function<bool()> go_on;                 // false: stop, and report so far
  std::function<void(double share)> solving;   // before the start
  std::function<void(double share)> settling;  // after the end, where weights were disputed
  std::function<void(double seconds, const Tally&, const Histogram& latency_ns)> second;
};

struct RunResult {
  Tally tally;
  Histogram latency_ns;  // from when a pose was due to when its weights came, Socket::arrived_ns()
  std::vector<Histogram> windows;
  Histogram send_delay_ns;            // by how much this program itself was late to send
  double seconds = 0.0;               // from the first pose due to the last, or to the interrupt
  double planned_seconds = 0.0;       // of which `windows` are equal parts
  double planned_rate = 0.0;          // poses a second
  std::optional<double> cpu_seconds;  // of the target's process, from start to end
  std::optional<ProcessUsage> usage;  // in the end
  bool usage_unknown = false;         // the server is on this machine, but its process is not known
  std::uint64_t overrun = 0;          // datagrams lost in this program's own full buffers
  std::uint64_t malformed = 0;        // messages that could not be decoded
  std::uint64_t churn_returns = 0;
  std::uint64_t burdens_cut = 0;  // as Burdens::cut()
  bool checked_names = false;     // the daemon's weights are named as the solver's
  std::string complaint;          // what the daemon said, or what ended the run before its time
  bool interrupted = false;       // by the caller
  bool ended_early = false;       // the daemon went away before the end; `complaint` says how

  [[nodiscard]] double p(double percentile) const {
    return static_cast<double>(latency_ns.Percentile(percentile)) * 1e-3;  // microseconds
  }
  // Microseconds of the target's processor time a pose.
  [[nodiscard]] std::optional<double> cpu_us_per_pose() const;
};

// One run from a fixed schedule: offers the subjects, subscribes, sends each pose when it is due,
// takes what comes, waits for the rest, judges it. One thread. Over UDP nothing is waited for that
// could delay the next pose. Over TCP a daemon that takes no more bytes holds up all poses, for at
// most five seconds: they are late to send then, which is counted. So does the connecting of a
// churning subscriber, for a round trip.
//
// Errors: kUnavailable (nobody answers), kInvalidArgument (the daemon refuses, and says why).
[[nodiscard]] Result<RunResult> Run(const Performance& performance, const Target& target,
                                    const RunOptions& options, const RunHooks& hooks);

}  // namespace furrow::load
