// SPDX-License-Identifier: Apache-2.0
#include "server/config/config_entries.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include <spdlog/fmt/fmt.h>

#include "base/joined.h"

namespace furrow::server {
namespace {

std::string Text(const std::string& value) { return value; }
std::string Text(const std::filesystem::path& value) { return value.string(); }
std::string Text(bool value) { return value ? "true" : "false"; }
std::string Text(int value) { return std::to_string(value); }
std::string Text(double value) { return fmt::format("{}", value); }
std::string Text(std::uint16_t value) { return std::to_string(value); }
std::string Text(Security value) { return value == Security::kRequired ? "required" : "open"; }
std::string Text(LogLevel value) { return std::string(LogLevelText(value)); }
std::string Text(const HostPort& value) { return HostPortText(value); }
std::string Text(const std::vector<std::string>& value) { return Joined(value); }
std::string Text(const std::vector<JitterRule>& rules) {
  return Joined(rules, [](const JitterRule& rule) {
    return rule.subjects + "=" + fmt::format("{}", rule.delay_ms);
  });
}
std::string Text(const std::vector<OscTargetConfig>& targets) {
  return Joined(targets, [](const OscTargetConfig& target) {
    return fmt::format("{} {} {} '{}' '{}' {}", HostPortText(target.to), target.profile,
                       target.prefix, target.subject, target.pattern, target.rate_hz);
  });
}
template <class T>
std::string Text(const std::optional<T>& value) {
  return value ? Text(*value) : std::string();
}

void AddInputs(const Config& config, std::vector<ConfigEntry>* entries) {
  const auto add = [entries](std::string_view key, const auto& value) {
    entries->push_back({key, Text(value)});
  };
  add("character", config.character);
  add("rig", config.rig);
  add("play", config.play);
  add("bvh_positions", config.bvh_positions);
  add("up_axis", config.up_axis);
  add("rest_frame", config.rest_frame);
  add("skeleton_map", config.skeleton_map);
  add("shape_map", config.shape_map);
  add("listen.bind", config.bind);
  add("listen.open", config.open);
  add("listen.tcp", config.tcp);
  add("listen.udp", config.udp);
  add("listen.threads", config.threads);
  add("listen.busy_poll_us", config.busy_poll_us);
  add("listen.jitter_buffer", config.jitter);
  add("security.mode", config.security.mode);
  add("security.keys", config.security.keys);
  add("security.name", config.security.name);
  add("security.tokens_in_clear", config.security.tokens_in_clear);
  add("security.confine", config.security.confine);
  add("tls.certificate", config.security.tls.certificate);
  add("tls.key", config.security.tls.key);
  add("tls.client_authority", config.security.tls.client_authority);
  add("mocap.vmc", config.vmc);
  add("mocap.livelink_face", config.livelink_face);
  add("mocap.allow", config.mocap_allow);
}

void AddOutputs(const Config& config, std::vector<ConfigEntry>* entries) {
  const auto add = [entries](std::string_view key, const auto& value) {
    entries->push_back({key, Text(value)});
  };
  add("render.enabled", config.render);
  add("render.required", config.require_render);
  add("render.settings", config.render_settings);
  add("render.device", config.render_device);
  add("render.max_video_encoders", config.max_video_encoders);
  add("render.max_host_megapixels_per_second", config.max_host_megapixels_per_second);
  add("render.max_megapixels_per_second", config.max_megapixels_per_second);
  add("osc.out", config.osc_out);
  add("osc.prefix", config.osc_prefix);
  add("osc.allow", config.osc.allow);
  add("osc.target", config.osc.targets);
  add("record.dir", config.record.folder);
  add("record.rotate_megabytes", config.record.rotate_megabytes);
  add("record.rotate_seconds", config.record.rotate_seconds);
  add("record.datagrams", config.record.datagrams);
  add("http.enabled", config.http.enabled);
  add("http.port", config.http.port);
  add("http.allow_hosts", config.http.allow_hosts);
  add("http.allow_origins", config.http.allow_origins);
  add("http.max_connections", config.http.max_connections);
  add("http.api_share", config.http.api_share);
  add("http.requests_per_second", config.http.requests_per_second);
  add("http.max_upload_megabytes", config.http.max_upload_megabytes);
  add("http.page", config.http.page);
  add("cluster.store", config.cluster.store);
  add("cluster.nodes", config.cluster.nodes);
  add("cluster.bucket", config.cluster.bucket);
  add("cluster.advertise", config.cluster.advertise);
  add("cluster.credentials", config.cluster.credentials);
  add("cluster.authority", config.cluster.authority);
  add("cluster.strict", config.cluster.strict);
  add("log.level", config.log_level);
  add("log.verbose", config.verbose);
  add("log.json", config.log_json);
}

void AddLimits(const Limits& limits, std::vector<ConfigEntry>* entries) {
  const auto add = [entries](std::string_view key, const auto& value) {
    entries->push_back({key, Text(value)});
  };
  add("limits.max_connections", limits.max_connections);
  add("limits.max_udp_peers", limits.max_udp_peers);
  add("limits.max_subjects", limits.max_subjects);
  add("limits.max_skeletons", limits.max_skeletons);
  add("limits.max_subscriptions", limits.max_subscriptions);
  add("limits.max_all_subscriptions", limits.max_all_subscriptions);
  add("limits.packets_per_second", limits.packets_per_second);
  add("limits.packet_burst", limits.packet_burst);
  add("limits.max_waiting_megabytes", limits.max_waiting_megabytes);
  add("limits.outbox_messages", limits.outbox_messages);
  add("limits.idle_seconds", limits.idle_seconds);
  add("limits.loss_seconds", limits.loss_seconds);
  add("limits.drain_seconds", limits.drain_seconds);
}

}  // namespace

std::vector<ConfigEntry> ConfigEntries(const Config& config) {
  std::vector<ConfigEntry> entries;
  AddInputs(config, &entries);
  AddOutputs(config, &entries);
  AddLimits(config.limits, &entries);
  return entries;
}

std::string ConfigSummary(const Config& config) {
  const std::vector<ConfigEntry> entries = ConfigEntries(config);
  const std::vector<ConfigEntry> defaults = ConfigEntries(Config());
  std::string summary;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].value == defaults[i].value) continue;
    summary += (summary.empty() ? "" : " ") + std::string(entries[i].key) + "=" + entries[i].value;
  }
  for (char& c : summary) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return summary.empty() ? "defaults" : summary;
}

}  // namespace furrow::server
