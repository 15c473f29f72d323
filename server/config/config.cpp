// SPDX-License-Identifier: Apache-2.0
#include "server/config/config.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include <asio/ip/address.hpp>

#include "base/status.h"
#include "protocol/secure/token/connect_token.h"

namespace furrow::server {
namespace {

Status Invalid(std::string what) { return Status(StatusCode::kInvalidArgument, std::move(what)); }

std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

// Values from a file are not trusted: zero would refuse everybody, and huge ones overflow durations
// in nanoseconds.
Status ValidateLimits(const Limits& limits) {
  const std::pair<const char*, int> counts[] = {
      {"max_connections", limits.max_connections},
      {"max_udp_peers", limits.max_udp_peers},
      {"max_subjects", limits.max_subjects},
      {"max_skeletons", limits.max_skeletons},
      {"max_all_subscriptions", limits.max_all_subscriptions},
      {"outbox_messages", limits.outbox_messages}};
  for (const auto& [name, value] : counts) {
    if (value < 1 || value > 1'000'000) {
      return Invalid(std::string("limits.") + name + " is " + std::to_string(value) +
                     "; it must be 1 to 1000000");
    }
  }
  // A peer's subscription ids are 16 bits and not 0.
  if (limits.max_subscriptions < 1 || limits.max_subscriptions > 65'535) {
    return Invalid("limits.max_subscriptions is " + std::to_string(limits.max_subscriptions) +
                   "; it must be 1 to 65535");
  }
  if (limits.max_all_subscriptions < limits.max_subscriptions) {
    return Invalid("limits.max_all_subscriptions is " +
                   std::to_string(limits.max_all_subscriptions) +
                   "; it must be at least limits.max_subscriptions, " +
                   std::to_string(limits.max_subscriptions));
  }
  // One host alone gets half, in which the largest picture must fit twice: while a snapshot is
  // sent.
  if (limits.max_waiting_megabytes < 72 || limits.max_waiting_megabytes > 1'000'000) {
    return Invalid("limits.max_waiting_megabytes is " +
                   std::to_string(limits.max_waiting_megabytes) + "; it must be 72 to 1000000");
  }
  const std::pair<const char*, double> numbers[] = {
      {"packets_per_second", limits.packets_per_second},
      {"packet_burst", limits.packet_burst},
      {"idle_seconds", limits.idle_seconds},
      {"loss_seconds", limits.loss_seconds},
      {"drain_seconds", limits.drain_seconds}};
  for (const auto& [name, value] : numbers) {
    // TOML has `nan` and `inf`. 1e9 s still fits into 64-bit nanoseconds.
    if (!std::isfinite(value) || value <= 0.0 || value > 1e9) {
      return Invalid(std::string("limits.") + name + " is " + NumberText(value) +
                     "; it must be greater than 0 and at most 1e9");
    }
  }
  return {};
}

// UDP services need different ports. TCP ports are separate from UDP ports.
Status ValidatePorts(const Config& config) {
  std::map<std::uint16_t, const char*> taken;
  const std::pair<const char*, std::optional<std::uint16_t>> ports[] = {
      {"--udp", config.udp}, {"--vmc", config.vmc}, {"--livelink-face", config.livelink_face}};
  for (const auto& [name, port] : ports) {
    // Port 0 selects any free port, so several may have it.
    if (!port || *port == 0) continue;
    const auto [other, is_new] = taken.emplace(*port, name);
    if (!is_new) {
      return Invalid(std::string(other->second) + " and " + name + " use the same UDP port " +
                     std::to_string(*port));
    }
  }
  return {};
}

Status ValidateSecurity(const Config& config) {
  const SecurityConfig& security = config.security;
  const bool required = security.mode == Security::kRequired;
  if (ListensToNetwork(config) && !config.open && !required) {
    return Status(StatusCode::kInvalidArgument,
                  "--bind " + config.bind +
                      " lets everybody on the network publish, watch and change settings",
                  "",
                  "use --security required with --keys FILE, and --tls-certificate for TCP and the "
                  "web page; add --open (listen.open = true) if that is intended, or use --bind "
                  "127.0.0.1");
  }
  if (required && config.open) {
    return Invalid("--open and --security required cannot be combined");
  }
  if (required && security.keys.empty()) {
    return Status(StatusCode::kInvalidArgument, "--security required needs --keys FILE", "",
                  "make one with 'furrow token key new --key FILE'");
  }
  const TlsFiles& tls = security.tls;
  if (tls.certificate.empty() != tls.key.empty()) {
    return Invalid("--tls-certificate and --tls-key need each other");
  }
  if (!tls.client_authority.empty() && !tls.enabled()) {
    return Invalid("--tls-client-authority needs --tls-certificate and --tls-key");
  }
  if (security.name.size() > protocol::secure::kMaxAudienceBytes) {
    return Invalid("--name has " + std::to_string(security.name.size()) + " bytes; the limit is " +
                   std::to_string(protocol::secure::kMaxAudienceBytes));
  }
  const bool has_wires = config.vmc || config.livelink_face;
  if (required && has_wires && ListensToNetwork(config) && config.mocap_allow.empty()) {
    return Status(StatusCode::kInvalidArgument,
                  "--vmc and --livelink-face cannot show a token, so with --security required "
                  "everybody on the network could publish there",
                  "", "name the senders with --mocap-allow ADDRESS");
  }
  return {};
}

}  // namespace

motion::LoadOptions ReadOptions(const Config& config) {
  motion::LoadOptions options;
  options.bvh_positions =
      motion::ParseBvhPositions(config.bvh_positions).value_or(motion::BvhPositions::kAuto);
  options.up_axis = motion::ParseUpAxis(config.up_axis).value_or(motion::UpAxis::kAuto);
  return options;
}

motion::LoadOptions PlayOptions(const Config& config) {
  motion::LoadOptions options = ReadOptions(config);
  options.rest_frame = config.rest_frame;
  return options;
}

bool ListensToNetwork(const Config& config) {
  asio::error_code error;
  const auto address = asio::ip::make_address(config.bind, error);
  return !error && !address.is_loopback();
}

Status ValidateConfig(const Config& config) {
  if (!IsNumericAddress(config.bind)) {
    return Status(StatusCode::kInvalidArgument,
                  "--bind: '" + config.bind + "' is not a numeric address", "",
                  "for example 127.0.0.1, 0.0.0.0 or ::1");
  }
  FURROW_RETURN_IF_ERROR(ValidateSecurity(config));
  FURROW_RETURN_IF_ERROR(ValidateCluster(config.cluster, config.security.name, config.bind));
  for (const std::string& address : config.mocap_allow) {
    if (!IsNumericAddress(address)) {
      return Status(StatusCode::kInvalidArgument,
                    "--mocap-allow: '" + address + "' is not a numeric address", "",
                    "for example 192.168.0.20 or ::1");
    }
  }
  if (config.threads < 1 || config.threads > kMaxThreads) {
    return Invalid("--threads is " + std::to_string(config.threads) + "; it must be 1 to " +
                   std::to_string(kMaxThreads));
  }
  if (config.busy_poll_us < 0 || config.busy_poll_us > kMaxBusyPollUs) {
    return Invalid("--busy-poll is " + std::to_string(config.busy_poll_us) + "; it must be 0 to " +
                   std::to_string(kMaxBusyPollUs) + " microseconds");
  }
  if (config.rest_frame < -1) {
    return Invalid("--rest-frame: " + std::to_string(config.rest_frame) +
                   " is not a frame; frames count from 0");
  }
  if (!motion::ParseBvhPositions(config.bvh_positions)) {
    return Invalid("--bvh-positions: '" + config.bvh_positions + "' is not one of " +
                   motion::kBvhPositionsWords);
  }
  if (!motion::ParseUpAxis(config.up_axis)) {
    return Invalid("--up-axis: '" + config.up_axis + "' is not one of auto, y or z");
  }
  if (config.require_render && !config.render) {
    return Invalid("--require-render and --no-render cannot be combined");
  }
  if (config.max_video_encoders < 0 || config.max_video_encoders > 1000) {
    return Invalid("render.max_video_encoders is " + std::to_string(config.max_video_encoders) +
                   "; it must be 0 to 1000");
  }
  for (const auto& [key, value] :
       {std::pair{"max_host_megapixels_per_second", config.max_host_megapixels_per_second},
        {"max_megapixels_per_second", config.max_megapixels_per_second}}) {
    // Also false for NaN.
    if (value >= 0.0 && value <= kMaxMegapixelsPerSecond) continue;
    return Invalid(std::string("render.") + key + " is " + NumberText(value) +
                   "; it must be 0 (no limit) to 1000000");
  }
  if (Status status = CheckOscTarget({.prefix = config.osc_prefix}); !status.ok()) {
    return Invalid("osc." + status.where() + " " + status.what());
  }
  for (const OscTargetConfig& target : config.osc.targets) {
    if (Status status = CheckOscTarget(target); !status.ok()) {
      return Invalid("osc.target: " + status.where() + " " + status.what());
    }
  }
  for (const std::string& address : config.osc.allow) {
    if (!IsNumericAddress(address)) {
      return Status(StatusCode::kInvalidArgument,
                    "osc.allow: '" + address + "' is not a numeric address", "",
                    "for example 192.168.0.20 or ::1");
    }
  }
  const std::pair<const char*, double> limits[] = {
      {"record.rotate_megabytes", config.record.rotate_megabytes},
      {"record.rotate_seconds", config.record.rotate_seconds}};
  for (const auto& [name, limit] : limits) {
    if (!std::isfinite(limit) || limit < 0.0 || limit > 1e9)
      return Invalid(std::string(name) + " is " + NumberText(limit) + "; it must be 0 to 1e9");
  }
  for (const std::string& host : config.http.allow_hosts) {
    if (host.empty() || host.find_first_of(":/ ") != std::string::npos) {
      return Status(StatusCode::kInvalidArgument, "--allow-host: '" + host + "' is not a host name",
                    "", "give the name alone, without scheme and port: furrow.example");
    }
  }
  for (const std::string& origin : config.http.allow_origins) {
    if (origin == "null") continue;  // of files and of frames in a sandbox
    const std::size_t scheme = origin.find("://");
    const std::size_t host = scheme == std::string::npos ? scheme : scheme + 3;
    if (scheme == std::string::npos || scheme == 0 || host == origin.size() ||
        origin.find_first_of("/ ", host) != std::string::npos) {
      return Status(StatusCode::kInvalidArgument,
                    "http.allow_origins: '" + origin + "' is not an origin", "",
                    "give scheme, host and port alone, as browsers send them, without a slash at "
                    "the end: https://furrow.example:8443");
    }
  }
  if (config.http.max_connections < 1 || config.http.max_connections > 1'000'000) {
    return Invalid("http.max_connections is " + std::to_string(config.http.max_connections) +
                   "; it must be 1 to 1000000");
  }
  if (!(config.http.api_share > 0.0 && config.http.api_share <= 1.0)) {
    return Invalid("http.api_share is " + NumberText(config.http.api_share) +
                   "; it must be more than 0 and at most 1");
  }
  if (config.http.max_upload_megabytes < 0 ||
      config.http.max_upload_megabytes > HttpConfig::kMostUploadMegabytes) {
    return Invalid("http.max_upload_megabytes is " +
                   std::to_string(config.http.max_upload_megabytes) + "; it must be 0 to " +
                   std::to_string(HttpConfig::kMostUploadMegabytes));
  }
  if (config.http.requests_per_second < 1 || config.http.requests_per_second > 1'000'000) {
    return Invalid("http.requests_per_second is " +
                   std::to_string(config.http.requests_per_second) + "; it must be 1 to 1000000");
  }
  if (config.http.enabled && config.http.port && *config.http.port != 0 &&
      *config.http.port == config.tcp) {
    return Invalid("--http and --tcp use the same TCP port " + std::to_string(config.tcp));
  }
  FURROW_RETURN_IF_ERROR(ValidatePorts(config));
  return ValidateLimits(config.limits);
}

}  // namespace furrow::server
