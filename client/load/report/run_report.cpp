// SPDX-License-Identifier: Apache-2.0
#include "client/load/report/run_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/table.h"

namespace furrow::load {
namespace {

using furrow::Counted;
using furrow::report::Fixed;
using furrow::report::Table;

std::string Count(std::uint64_t value) { return std::to_string(value); }

// For people; the JSON report has bytes.
std::string Mebibytes(std::uint64_t bytes) {
  return Fixed(static_cast<double>(bytes) / (1 << 20), 1) + " MiB";
}

// Remarks about anything that limits what the figures mean.
std::string RunRemarks(const RunResult& result, const RunOptions& options) {
  std::string text;
  const auto remark = [&text](const std::string& sentence) { text += sentence + "\n"; };
  if (result.interrupted) remark("Interrupted: these are the figures so far.");
  if (result.ended_early) {
    remark("The run ended early: " + result.complaint + ".");
  } else if (!result.complaint.empty()) {
    remark("Reported during the run: " + result.complaint + ".");
  }
  if (result.tally.sent < result.tally.offered) {
    remark(Counted(result.tally.offered - result.tally.sent, "pose") +
           " could not be sent when due, because the system accepted no more datagrams. These "
           "poses do "
           "not count as lost.");
  }
  if (!result.checked_names && options.check_weights)
    remark("Weights were not checked: the daemon's weight names differ from those of --rig.");
  if (result.tally.unfollowed > 0) {
    remark(Counted(result.tally.unfollowed, "pose") +
           " had weights that differ from the solver's, too many to analyse; they count as "
           "unchecked.");
  }
  if (result.tally.aged > 0) {
    remark("The daemon sent " + Counted(result.tally.aged, "message") +
           " of decaying weights, because it received no pose of a subject for half a second. "
           "Poses were sent up to " +
           Fixed(static_cast<double>(result.send_delay_ns.max()) * 1e-9, 1) + " s late.");
  }
  if (result.overrun > 0) {
    remark("The load generator's own buffers lost " + Counted(result.overrun, "datagram") +
           "; it is too slow for this rate.");
  }
  if (result.subscribers_cut > 0) {
    remark("The daemon disconnected slow or stalled subscribers " +
           Counted(result.subscribers_cut, "time") + "; they reconnected.");
  }
  if (options.misbehavior.churn > 0) {
    remark("Churning subscribers reconnected " + Counted(result.churn_returns, "time") + ".");
  }
  if (result.usage_unknown) {
    remark(
        "The daemon's processor time and memory are unknown, because its process was not found or "
        "is not readable. Name the process with --pid.");
  }
  if (result.tally.early > 0) {
    remark(
        "The weights of " + Counted(result.tally.early, "pose") +
        " arrived before the pose was due, according to this machine's clocks, which were set or "
        "disagree; their latency counts as 0 ms.");
  }
  // A quarter of the latency: below that, the delay of the generator hardly changes the figures.
  const double behind_us = static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-3;
  if (behind_us > 0.25 * result.p(99.0)) {
    remark("The load generator sent poses up to " + Fixed(behind_us, 0) +
           " us late (p99), which counts as latency; the machine is busy.");
  }
  return text;
}

// The names are part of the JSON format; scripts read them.
nlohmann::json CountsOf(const RunResult& result) {
  const Tally& tally = result.tally;
  return {{"offered", tally.offered},
          {"sent", tally.sent},
          {"expected", tally.expected},
          {"received", tally.received},
          {"lost", tally.lost()},
          {"late", tally.late},
          {"early", tally.early},
          {"wrong", tally.wrong},
          {"swapped", tally.swapped},
          {"falsified", tally.falsified()},
          {"unclassified", tally.unclassified},
          {"reordered", tally.reordered},
          {"duplicates", tally.duplicates},
          {"never_sent", tally.never_sent},
          {"malformed", result.malformed},
          {"checked", tally.checked},
          {"unchecked", tally.unchecked},
          {"unfollowed", tally.unfollowed},
          {"aged", tally.aged},
          {"overrun", result.overrun},
          {"churn_returns", result.churn_returns},
          {"burdens_cut", result.subscribers_cut}};
}

}  // namespace

std::string LiveLine(double seconds, const Tally& tally, const Histogram& latency_ns) {
  const auto milliseconds = [&](double percentile) {
    return Fixed(static_cast<double>(latency_ns.Percentile(percentile)) * 1e-6, 3);
  };
  return Fixed(seconds, 0) + " s: sent " + Count(tally.sent) + ", received " +
         Count(tally.received) + ", in flight or lost " + Count(tally.lost()) + ", late " +
         Count(tally.late) + "; p50 " + milliseconds(50.0) + " ms, p99 " + milliseconds(99.0) +
         " ms";
}

std::string ToText(const RunResult& result, const RunOptions& options) {
  const Tally& tally = result.tally;
  Table poses{
      "Poses and weights",
      {"offered", "sent", "expected", "received", "lost", "late", "wrong", "reordered",
       "duplicates", "never sent", "malformed"},
      {{Count(tally.offered), Count(tally.sent), Count(tally.expected), Count(tally.received),
        Count(tally.lost()), Count(tally.late), Count(tally.wrong), Count(tally.reordered),
        Count(tally.duplicates), Count(tally.never_sent), Count(result.malformed)}}};
  Table latency{"Latency (ms) from the due time of a pose to the arrival of its weights",
                {"p50", "p90", "p99", "p99.9", "max", "send delay, p99"},
                {{}}};
  // Percentile 100 is the maximum.
  for (const double percentile : {50.0, 90.0, 99.0, 99.9, 100.0})
    latency.rows[0].push_back(Fixed(result.p(percentile) * 1e-3, 3));
  latency.rows[0].push_back(
      Fixed(static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-6, 3));
  std::string text = ToMarkdown(poses) + "\n" + ToMarkdown(latency) + "\n";
  if (result.usage && result.cpu_seconds) {
    const Table usage{
        "Daemon",
        {"CPU (% of a core)", "us per pose", "memory", "peak memory"},
        {{Fixed(100.0 * *result.cpu_seconds / std::max(result.seconds, 1e-3), 1),
          Fixed(result.cpu_us_per_pose().value_or(0.0), 2), Mebibytes(result.usage->resident_bytes),
          Mebibytes(result.usage->peak_resident_bytes)}}};
    text += ToMarkdown(usage) + "\n";
  }
  text += "Weights checked against the solver: " + Count(tally.checked) + " (tolerance " +
          Fixed(options.tolerance, 6) +
          "); largest difference of the correct ones: " + Fixed(tally.largest_difference, 7) +
          "; unchecked: " + Count(tally.unchecked) + ".\n";
  if (tally.wrong > 0) {
    text +=
        "Of the wrong weights, " + Count(tally.swapped) +
        " belong to another pose or subject (swapped), " + Count(tally.falsified()) +
        " match no pose (falsified)" +
        (tally.unclassified > 0 ? ", " + Count(tally.unclassified) + " were not classified" : "") +
        ".\n";
  }
  return text + RunRemarks(result, options);
}

nlohmann::json ToJson(const RunResult& result) {
  nlohmann::json json = CountsOf(result);
  json["seconds"] = result.seconds;
  json["poses_per_second"] = result.planned_rate;
  json["largest_difference"] = result.tally.largest_difference;
  json["interrupted"] = result.interrupted;
  json["ended_early"] = result.ended_early;
  json["complaint"] = result.complaint;
  json["latency_us"] = {{"p50", result.p(50.0)},
                        {"p90", result.p(90.0)},
                        {"p99", result.p(99.0)},
                        {"p99.9", result.p(99.9)},
                        {"max", result.p(100.0)}};
  json["send_delay_p99_us"] = static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-3;
  json["send_delay_max_us"] = static_cast<double>(result.send_delay_ns.max()) * 1e-3;
  if (result.cpu_seconds) {
    json["cpu_seconds"] = *result.cpu_seconds;
    json["cpu_us_per_pose"] = result.cpu_us_per_pose().value_or(0.0);
  }
  if (result.usage) {
    json["resident_bytes"] = result.usage->resident_bytes;
    json["peak_resident_bytes"] = result.usage->peak_resident_bytes;
  }
  return json;
}

}  // namespace furrow::load
