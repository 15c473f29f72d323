// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/status.h"
#include "base/text.h"
#include "protocol/secure/token/connect_token.h"
#include "server/cluster/node/node_address.h"
#include "server/config/config.h"
#include "server/config/settings.h"

namespace furrow::server {
namespace {

using Fault = std::optional<ConfigFault>;

// Of several settings, or of one that a flag may have set.
Fault FaultOfFlag(std::string what, std::string todo = {}) {
  return ConfigFault{{}, {StatusCode::kInvalidArgument, std::move(what), "", std::move(todo)}};
}

// Of a value that only the file can have set. The message begins with its key.
Fault FaultOfKey(std::string_view key, const std::string& rest, std::string todo = {}) {
  return ConfigFault{key,
                     {StatusCode::kInvalidArgument, std::string(key) + rest, "", std::move(todo)}};
}

std::string NumberText(int value) { return std::to_string(value); }

std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

std::string RangeText(const Range& range) {
  if (!range.words.empty()) return std::string(range.words);
  return NumberText(static_cast<int>(range.least)) + " to " +
         NumberText(static_cast<int>(range.most));
}

// Flags check these ranges themselves, so the file is at fault. Ports have the range of their type.
Fault FaultOfRanges(const Config& config) {
  Fault fault;
  const auto check = [&](const Setting& setting, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, double>) {
      if (fault || Contains(setting.range, value)) return;
      const std::string_view name = setting.flag.empty() ? setting.key : setting.flag;
      fault = ConfigFault{
          setting.key,
          {StatusCode::kInvalidArgument, std::string(name) + " is " + NumberText(value) +
                                             "; it must be " + RangeText(setting.range)}};
    }
  };
  VisitSettings(check, config);
  return fault;
}

Fault FaultOfBind(const Config& config) {
  if (IsNumericAddress(config.bind)) return {};
  return FaultOfFlag("--bind: '" + config.bind + "' is not a numeric address",
                     "for example 127.0.0.1, 0.0.0.0 or ::1");
}

// Whether everybody could do everything.
Fault FaultOfAccess(const Config& config) {
  const SecurityConfig& security = config.security;
  const bool required = security.mode == Security::kRequired;
  if (ListensToNetwork(config) && !config.open && !required) {
    return FaultOfFlag(
        "--bind " + config.bind +
            " lets everybody on the network publish, watch and change settings",
        "use --security required with --keys FILE, and --tls-certificate for TCP and the web page; "
        "add --open (listen.open = true) if that is intended, or use --bind 127.0.0.1");
  }
  if (required && config.open) {
    return FaultOfFlag("--open and --security required cannot be combined");
  }
  if (required && security.keys.empty()) {
    return FaultOfFlag("--security required needs --keys FILE",
                       "make one with 'furrow token key new --key FILE'");
  }
  const bool has_wires = config.vmc || config.livelink_face;
  if (required && has_wires && ListensToNetwork(config) && config.mocap_allow.empty()) {
    return FaultOfFlag(
        "--vmc and --livelink-face cannot show a token, so with --security required everybody on "
        "the network could publish there",
        "name the senders with --mocap-allow ADDRESS");
  }
  return {};
}

// The certificate and the name by which the daemon is known.
Fault FaultOfIdentity(const Config& config) {
  const TlsFiles& tls = config.security.tls;
  if (tls.certificate.empty() != tls.key.empty()) {
    return FaultOfFlag("--tls-certificate and --tls-key need each other");
  }
  if (!tls.client_authority.empty() && !tls.enabled()) {
    return FaultOfFlag("--tls-client-authority needs --tls-certificate and --tls-key");
  }
  const std::size_t bytes = config.security.name.size();
  if (bytes > protocol::secure::kMaxAudienceBytes) {
    return FaultOfFlag("--name has " + std::to_string(bytes) + " bytes; the limit is " +
                       std::to_string(protocol::secure::kMaxAudienceBytes));
  }
  return {};
}

Fault FaultOfCluster(const Config& config) {
  const ClusterConfig& cluster = config.cluster;
  Status status = ValidateCluster(cluster, config.security.name, config.bind);
  if (!status.ok()) return ConfigFault{{}, std::move(status)};
  // Without a store, the name of its bucket does not matter.
  if (cluster.store.empty() || IsNodeName(cluster.bucket)) return {};
  return FaultOfKey("cluster.bucket", ": " + Quoted(cluster.bucket) +
                                          " is not a name of letters, digits, '-' and '_'");
}

Fault FaultOfInputs(const Config& config) {
  for (const std::string& address : config.mocap_allow) {
    if (IsNumericAddress(address)) continue;
    return FaultOfFlag("--mocap-allow: '" + address + "' is not a numeric address",
                       "for example 192.168.0.20 or ::1");
  }
  if (config.rest_frame < -1) {
    // The flag checks its range itself.
    return ConfigFault{
        "rest_frame",
        {StatusCode::kInvalidArgument, "--rest-frame: " + std::to_string(config.rest_frame) +
                                           " is not a frame; frames count from 0"}};
  }
  if (!motion::ParseBvhPositions(config.bvh_positions)) {
    return FaultOfFlag("--bvh-positions: '" + config.bvh_positions + "' is not one of " +
                       motion::kBvhPositionsWords);
  }
  if (!motion::ParseUpAxis(config.up_axis)) {
    return FaultOfFlag("--up-axis: '" + config.up_axis + "' is not one of auto, y or z");
  }
  return {};
}

Fault FaultOfRendering(const Config& config) {
  if (!config.require_render || config.render) return {};
  return FaultOfFlag("--require-render and --no-render cannot be combined");
}

Fault FaultOfOsc(const Config& config) {
  if (Status status = CheckOscTarget({.prefix = config.osc_prefix}); !status.ok()) {
    return FaultOfFlag("osc." + status.where() + " " + status.what());
  }
  for (const OscTargetConfig& target : config.osc.targets) {
    if (Status status = CheckOscTarget(target); !status.ok()) {
      return FaultOfKey("osc.target", ": " + status.where() + " " + status.what());
    }
  }
  for (const std::string& address : config.osc.allow) {
    if (IsNumericAddress(address)) continue;
    return FaultOfKey("osc.allow", ": '" + address + "' is not a numeric address",
                      "for example 192.168.0.20 or ::1");
  }
  return {};
}

// "https://stage.example:8443", or the "null" of files and of frames in a sandbox.
bool IsOrigin(std::string_view text) {
  if (text == "null") return true;
  const std::size_t scheme = text.find("://");
  if (scheme == std::string_view::npos || scheme == 0) return false;
  const std::string_view host = text.substr(scheme + 3);
  return !host.empty() && host.find_first_of("/ ") == std::string_view::npos;
}

Fault FaultOfPages(const Config& config) {
  for (const std::string& host : config.http.allow_hosts) {
    if (!host.empty() && host.find_first_of(":/ ") == std::string::npos) continue;
    return FaultOfFlag("--allow-host: '" + host + "' is not a host name",
                       "give the name alone, without scheme and port: furrow.example");
  }
  for (const std::string& origin : config.http.allow_origins) {
    if (IsOrigin(origin)) continue;
    return FaultOfKey("http.allow_origins", ": '" + origin + "' is not an origin",
                      "give scheme, host and port alone, as browsers send them, without a slash at "
                      "the end: https://furrow.example:8443");
  }
  return {};
}

// TCP ports are separate from UDP ports. Port 0 selects any free port, so several may have it.
Fault FaultOfPorts(const Config& config) {
  if (config.http.enabled && config.http.port && *config.http.port != 0 &&
      *config.http.port == config.tcp) {
    return FaultOfFlag("--http and --tcp use the same TCP port " + std::to_string(config.tcp));
  }
  std::map<std::uint16_t, const char*> taken;
  const std::pair<const char*, std::optional<std::uint16_t>> ports[] = {
      {"--udp", config.udp}, {"--vmc", config.vmc}, {"--livelink-face", config.livelink_face}};
  for (const auto& [name, port] : ports) {
    if (!port || *port == 0) continue;
    const auto [other, is_new] = taken.emplace(*port, name);
    if (!is_new) {
      return FaultOfFlag(std::string(other->second) + " and " + name + " use the same UDP port " +
                         std::to_string(*port));
    }
  }
  return {};
}

Fault FaultOfSubscriptions(const Config& config) {
  const Limits& limits = config.limits;
  if (limits.max_all_subscriptions >= limits.max_subscriptions) return {};
  return FaultOfKey("limits.max_all_subscriptions",
                    " is " + std::to_string(limits.max_all_subscriptions) +
                        "; it must be at least limits.max_subscriptions, " +
                        std::to_string(limits.max_subscriptions));
}

}  // namespace

std::optional<ConfigFault> FindFault(const Config& config) {
  for (const auto& fault_of :
       {FaultOfBind, FaultOfAccess, FaultOfIdentity, FaultOfCluster, FaultOfInputs, FaultOfRanges,
        FaultOfRendering, FaultOfOsc, FaultOfPages, FaultOfPorts, FaultOfSubscriptions}) {
    if (Fault fault = fault_of(config)) return fault;
  }
  return {};
}

Status ValidateConfig(const Config& config) {
  const Fault fault = FindFault(config);
  return fault ? fault->status : Status();
}

}  // namespace furrow::server
