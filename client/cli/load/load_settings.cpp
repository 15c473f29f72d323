// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_settings.h"

#include <string>

#include <nlohmann/json.hpp>

#include "client/chaos/report.h"

namespace furrow::cli {
namespace {

nlohmann::json TextOrNull(const std::string& text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

const char* NameOf(Packing packing) {
  switch (packing) {
    case Packing::kAlways: return "always";
    case Packing::kNever: return "never";
    case Packing::kToFit: break;
  }
  return "to fit";
}

const char* NameOf(load::Path path) {
  switch (path) {
    case load::Path::kTcp: return "tcp";
    case load::Path::kBoth: return "both";
    case load::Path::kUdp: break;
  }
  return "udp";
}

nlohmann::json ChaosOf(const ChaosFlags& flags) {
  chaos::Faults up;
  chaos::Faults down;
  ReadChaosFlags(flags, &up, &down);
  return {{"up", up.any() ? chaos::ToJson(up) : nlohmann::json()},
          {"down", down.any() ? chaos::ToJson(down) : nlohmann::json()}};
}

nlohmann::json ComparisonOf(const LoadFlags& flags) {
  const load::ComparisonOptions& options = flags.comparison;
  return {{"find_max", flags.find_max},
          {"baseline", flags.baseline},
          {"rounds", options.rounds},
          {"round_seconds", flags.round_seconds},
          {"searches", options.searches},
          {"probe_seconds", options.probe_seconds},
          {"search_limit", options.search_limit},
          {"time_limit_minutes", flags.time_limit_minutes}};
}

}  // namespace

nlohmann::json SettingsOf(const LoadFlags& flags) {
  const load::RunOptions& run = flags.run;
  nlohmann::json json{
      {"version", FURROW_VERSION},
      {"host", flags.host.substr(0, flags.host.find('?'))},  // what follows may be a token
      {"tls", flags.security.tls},
      {"file", flags.input.file},
      {"rig", TextOrNull(flags.input.rig)},
      {"skeleton_map", TextOrNull(flags.input.skeleton_map)},
      {"shape_map", TextOrNull(flags.input.shape_map)},
      {"rest_frame", flags.input.read.rest_frame},
      {"packing", NameOf(PackingOf(flags))},
      {"redundant", run.redundant},
      {"scale", flags.input.scale},
      {"path", NameOf(run.path)},
      {"subjects", run.plan.subjects},
      {"first", run.first},
      {"rate", run.plan.rate > 0.0 ? nlohmann::json(run.plan.rate) : nlohmann::json()},
      {"duration_seconds", run.plan.seconds},
      {"clock_step_seconds", run.plan.clock_step},
      {"clock_every_seconds", run.plan.clock_every},
      {"subscribers", run.watchers},
      {"slow", run.misbehavior.slow},
      {"stalled", run.misbehavior.stalled},
      {"churn", run.misbehavior.churn},
      {"tolerance", run.tolerance},
      {"late_ms", flags.late_ms},
      {"drain_seconds", run.drain_seconds},
      {"chaos", ChaosOf(flags.chaos)}};
  if (flags.find_max || flags.baseline) json["comparison"] = ComparisonOf(flags);
  return json;
}

}  // namespace furrow::cli
