// SPDX-License-Identifier: Apache-2.0
#include "server/config/config.h"

#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>

#include "base/status.h"

namespace furrow::server {
namespace {

bool IsNumericAddress(const std::string& address) {
  in6_addr buffer;
  return inet_pton(AF_INET, address.c_str(), &buffer) == 1 ||
         inet_pton(AF_INET6, address.c_str(), &buffer) == 1;
}

Status OutOfRange(std::string what) {
  return Status(StatusCode::kInvalidArgument, std::move(what));
}

Status ValidateLimits(const Limits& limits) {
  const std::pair<const char*, int> counts[] = {
      {"max_connections", limits.max_connections},     {"max_udp_peers", limits.max_udp_peers},
      {"max_subjects", limits.max_subjects},           {"max_skeletons", limits.max_skeletons},
      {"max_subscriptions", limits.max_subscriptions}, {"outbox_messages", limits.outbox_messages}};
  for (const auto& [name, value] : counts) {
    if (value < 1 || value > 1'000'000) {
      return OutOfRange(std::string("limits.") + name + " must be 1 to 1000000");
    }
  }
  const std::pair<const char*, double> numbers[] = {
      {"packets_per_second", limits.packets_per_second},
      {"packet_burst", limits.packet_burst},
      {"idle_seconds", limits.idle_seconds},
      {"loss_seconds", limits.loss_seconds},
      {"drain_seconds", limits.drain_seconds}};
  for (const auto& [name, value] : numbers) {
    if (!std::isfinite(value) || value <= 0.0 || value > 1e9) {
      return OutOfRange(std::string("limits.") + name + " must be more than 0, at most 1e9");
    }
  }
  return {};
}

// UDP services that would fight over one port; TCP is a space of its own.
Status ValidatePorts(const Config& config) {
  std::map<std::uint16_t, const char*> taken;
  const std::pair<const char*, std::optional<std::uint16_t>> ports[] = {
      {"--udp", config.udp}, {"--vmc", config.vmc}, {"--livelink-face", config.livelink_face}};
  for (const auto& [name, port] : ports) {
    if (!port || *port == 0) continue;
    const auto [other, is_new] = taken.emplace(*port, name);
    if (!is_new) {
      return OutOfRange(std::string(other->second) + " and " + name + " name the same UDP port, " +
                        std::to_string(*port));
    }
  }
  return {};
}

}  // namespace

Status ValidateConfig(const Config& config) {
  if (!IsNumericAddress(config.bind)) {
    return Status(StatusCode::kInvalidArgument, "--bind: '" + config.bind + "' is no address", "",
                  "give a numeric one: 127.0.0.1, 0.0.0.0, ::1");
  }
  for (const std::string& address : config.mocap_allow) {
    if (!IsNumericAddress(address)) {
      return Status(StatusCode::kInvalidArgument, "--mocap-allow: '" + address + "' is no address",
                    "", "give numeric ones: 192.168.0.20, ::1");
    }
  }
  if (config.threads < 1 || config.threads > kMaxThreads) {
    return OutOfRange("--threads must be 1 to " + std::to_string(kMaxThreads));
  }
  if (config.require_render && !config.render) {
    return OutOfRange("--require-render and --no-render exclude each other");
  }
  if (config.osc_prefix.empty() ||
      config.osc_prefix.find_first_of(" #*,?[]{}") != std::string::npos) {
    return OutOfRange("osc.prefix '" + config.osc_prefix + "' is no part of an OSC address");
  }
  for (const double limit : {config.record.rotate_megabytes, config.record.rotate_seconds}) {
    if (!std::isfinite(limit) || limit < 0.0 || limit > 1e9)
      return OutOfRange("record.rotate_megabytes and rotate_seconds must be 0 to 1e9");
  }
  if (config.http.max_connections < 1 || config.http.max_connections > 1'000'000) {
    return OutOfRange("http.max_connections must be 1 to 1000000");
  }
  if (config.http.enabled && config.http.port && *config.http.port != 0 &&
      *config.http.port == config.tcp) {
    return OutOfRange("--http and --tcp name the same TCP port, " + std::to_string(config.tcp));
  }
  FURROW_RETURN_IF_ERROR(ValidatePorts(config));
  return ValidateLimits(config.limits);
}

Result<HostPort> ParseHostPort(std::string_view text) {
  const Status error(StatusCode::kInvalidArgument, "'" + std::string(text) + "' is no HOST:PORT",
                     "", "give a numeric address: 127.0.0.1:9000 or [::1]:9000");
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return error;
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return error;
  }
  HostPort result{std::string(host), 0};
  const auto [end, code] = std::from_chars(port.data(), port.data() + port.size(), result.port);
  if (code != std::errc() || end != port.data() + port.size() || result.port == 0 ||
      !IsNumericAddress(result.host)) {
    return error;
  }
  return result;
}

}  // namespace furrow::server
