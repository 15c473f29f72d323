// SPDX-License-Identifier: Apache-2.0
#include "server/config/reload_plan.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "server/config/config_entries.h"

namespace furrow::server {
namespace {

// A key that takes effect without a restart, and how to take it over.
struct LiveKey {
  std::string_view key;
  void (*take)(Config* running, const Config& wanted);
};

constexpr LiveKey kLiveKeys[] = {
    {"rig", [](Config* r, const Config& w) { r->rig = w.rig; }},
    {"skeleton_map", [](Config* r, const Config& w) { r->skeleton_map = w.skeleton_map; }},
    {"shape_map", [](Config* r, const Config& w) { r->shape_map = w.shape_map; }},
    {"security.keys", [](Config* r, const Config& w) { r->security.keys = w.security.keys; }},
    {"tls.certificate",
     [](Config* r, const Config& w) { r->security.tls.certificate = w.security.tls.certificate; }},
    {"tls.key", [](Config* r, const Config& w) { r->security.tls.key = w.security.tls.key; }},
    {"tls.client_authority",
     [](Config* r, const Config& w) {
       r->security.tls.client_authority = w.security.tls.client_authority;
     }},
    {"mocap.allow", [](Config* r, const Config& w) { r->mocap_allow = w.mocap_allow; }},
    {"osc.allow", [](Config* r, const Config& w) { r->osc.allow = w.osc.allow; }},
    {"http.allow_hosts",
     [](Config* r, const Config& w) { r->http.allow_hosts = w.http.allow_hosts; }},
    {"http.allow_origins",
     [](Config* r, const Config& w) { r->http.allow_origins = w.http.allow_origins; }},
    {"http.max_connections",
     [](Config* r, const Config& w) { r->http.max_connections = w.http.max_connections; }},
    {"http.api_share", [](Config* r, const Config& w) { r->http.api_share = w.http.api_share; }},
    {"http.requests_per_second",
     [](Config* r, const Config& w) { r->http.requests_per_second = w.http.requests_per_second; }},
    {"http.max_upload_megabytes",
     [](Config* r, const Config& w) {
       r->http.max_upload_megabytes = w.http.max_upload_megabytes;
     }},
    {"log.level", [](Config* r, const Config& w) { r->log_level = w.log_level; }},
    {"log.verbose", [](Config* r, const Config& w) { r->verbose = w.verbose; }},
    {"limits.max_connections",
     [](Config* r, const Config& w) { r->limits.max_connections = w.limits.max_connections; }},
    {"limits.max_subjects",
     [](Config* r, const Config& w) { r->limits.max_subjects = w.limits.max_subjects; }},
    {"limits.max_skeletons",
     [](Config* r, const Config& w) { r->limits.max_skeletons = w.limits.max_skeletons; }},
    {"limits.max_subscriptions",
     [](Config* r, const Config& w) { r->limits.max_subscriptions = w.limits.max_subscriptions; }},
    {"limits.max_all_subscriptions",
     [](Config* r, const Config& w) {
       r->limits.max_all_subscriptions = w.limits.max_all_subscriptions;
     }},
    {"limits.packets_per_second",
     [](Config* r, const Config& w) {
       r->limits.packets_per_second = w.limits.packets_per_second;
     }},
    {"limits.packet_burst",
     [](Config* r, const Config& w) { r->limits.packet_burst = w.limits.packet_burst; }},
    {"limits.max_waiting_megabytes",
     [](Config* r,
        const Config& w) { r->limits.max_waiting_megabytes = w.limits.max_waiting_megabytes; }},
    {"limits.outbox_messages",
     [](Config* r, const Config& w) { r->limits.outbox_messages = w.limits.outbox_messages; }},
    {"limits.idle_seconds",
     [](Config* r, const Config& w) { r->limits.idle_seconds = w.limits.idle_seconds; }},
    {"limits.loss_seconds",
     [](Config* r, const Config& w) { r->limits.loss_seconds = w.limits.loss_seconds; }},
    {"limits.drain_seconds",
     [](Config* r, const Config& w) { r->limits.drain_seconds = w.limits.drain_seconds; }}};

// Whether a live key must wait for a restart this time.
bool MustWait(std::string_view key, const Config& running, const Config& wanted, bool draws) {
  const TlsFiles& old_tls = running.security.tls;
  const TlsFiles& new_tls = wanted.security.tls;
  if (key.starts_with("tls.")) {
    return old_tls.enabled() != new_tls.enabled() ||
           old_tls.client_authority.empty() != new_tls.client_authority.empty();
  }
  // Without a rig of its own, the daemon uses that of the character.
  if (key == "rig") {
    return draws || running.rig.empty() || wanted.rig.empty() || !running.character.empty();
  }
  return false;
}

}  // namespace

ReloadPlan PlanReload(const Config& running, const Config& wanted, bool draws) {
  ReloadPlan plan;
  plan.config = running;
  const std::vector<ConfigEntry> before = ConfigEntries(running);
  const std::vector<ConfigEntry> after = ConfigEntries(wanted);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].value == after[i].value) continue;
    const std::string_view key = before[i].key;
    const auto* const live = std::ranges::find(kLiveKeys, key, &LiveKey::key);
    if (live == std::end(kLiveKeys) || MustWait(key, running, wanted, draws)) {
      plan.needs_restart.emplace_back(key);
    } else {
      live->take(&plan.config, wanted);
      plan.applied.emplace_back(key);
    }
  }
  return plan;
}

}  // namespace furrow::server
