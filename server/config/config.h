// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "server/config/http_config.h"
#include "server/core/exit_code.h"

namespace furrow::server {

// Where OSC goes to: a numeric address and a port.
struct HostPort {
  std::string host;
  std::uint16_t port = 0;
  friend bool operator==(const HostPort&, const HostPort&) = default;
};

// What one daemon takes on before it refuses or drops. All per daemon unless said otherwise.
struct Limits {
  int max_connections = 256;  // TCP
  int max_udp_peers = 4096;   // addresses remembered; the longest silent one goes first
  int max_subjects = 1024;
  int max_skeletons = 256;            // offered skeletons kept
  int max_subscriptions = 64;         // of one peer
  double packets_per_second = 20000;  // of one peer: datagrams or TCP messages
  double packet_burst = 4000;         // of one peer, at once
  int outbox_messages = 64;           // of one TCP peer; frames beyond it replace older ones
  double idle_seconds = 30;           // a peer that is silent and gets nothing is forgotten
  double loss_seconds = 0.5;          // a subject without poses for so long is lost and decays
  double drain_seconds = 2;           // after SIGTERM: what is queued may still leave
  friend bool operator==(const Limits&, const Limits&) = default;
};

// Where everything that streams is recorded, and when the next file begins.
struct RecordConfig {
  std::filesystem::path folder;    // made where it is absent; empty: nothing is recorded
  double rotate_megabytes = 1024;  // 0: never for its size
  double rotate_seconds = 3600;    // 0: never for its age
  bool datagrams = true;           // with them as they came
  friend bool operator==(const RecordConfig&, const RecordConfig&) = default;
};

inline constexpr int kMaxThreads = 64;

// All that furrowd can be told, by flags or by a TOML file (furrow.example.toml shows every key).
struct Config {
  std::filesystem::path character;  // both empty: the default character of FURROW_DATA_DIR
  std::string skeleton_map;         // name or file; empty: the best of those that ship
  std::filesystem::path rig;        // alone: weights only; with a character: instead of its own
  std::string bind = "127.0.0.1";   // numeric, IPv4 or IPv6
  std::uint16_t tcp = 7400;         // 0: any free port; the ready line says which
  std::uint16_t udp = 7401;
  int threads = 1;  // that take in datagrams, [1, kMaxThreads]; see docs/CAPACITY.md
  bool render = true;
  bool require_render = false;            // no GL: end instead of going on without pictures
  std::string render_device;              // see render::RendererOptions::device
  std::filesystem::path render_settings;  // TOML (render::LoadSettings); empty: the defaults
  std::optional<std::uint16_t> vmc;
  std::optional<std::uint16_t> livelink_face;
  std::vector<std::string> mocap_allow;  // numeric addresses that may feed those; none: anybody
  std::optional<HostPort> osc_out;
  std::string osc_prefix = "furrow";  // /<prefix>/<subject>/<wrinkle weight>
  RecordConfig record;
  HttpConfig http;
  std::filesystem::path play;  // a recording that plays inside the daemon; empty: none
  bool verbose = false;        // one status line a second
  bool log_json = false;
  Limits limits;
  friend bool operator==(const Config&, const Config&) = default;
};

// Reads a TOML config over `config`: what the file does not say stays.
//
// Errors: kNotFound, kIo, kParse, kSchema (unknown key, wrong type), kInvalidArgument (out of
// range); `where` is "file:line", the message names the key.
[[nodiscard]] Status LoadConfigFile(const std::filesystem::path& path, Config* config);
[[nodiscard]] Status ParseConfig(std::string_view toml, std::string_view source_name,
                                 Config* config);

// What is wrong with the whole, whoever said it: an address that is not numeric, a limit out of
// range, two services on one port, --require-render with --no-render.
[[nodiscard]] Status ValidateConfig(const Config& config);

// "127.0.0.1:9000" or "[::1]:9000".
[[nodiscard]] Result<HostPort> ParseHostPort(std::string_view text);

// The command line, parsed. No config: print `text` (help or version on kOk, else an error) and
// end.
struct CommandLine {
  std::optional<Config> config;
  ExitCode exit_code = ExitCode::kOk;
  std::string text;
};

// Flags win over the file of --config, the file over the defaults. `args` without the program name.
[[nodiscard]] CommandLine ParseCommandLine(std::span<const std::string> args);

}  // namespace furrow::server
