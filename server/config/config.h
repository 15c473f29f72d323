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
#include "motion/clip/clip.h"
#include "server/config/cluster_config.h"
#include "server/config/http_config.h"
#include "server/config/osc_config.h"
#include "server/config/security_config.h"
#include "server/core/exit_code.h"
#include "server/core/jitter_rule.h"
#include "server/core/limits.h"
#include "server/core/log_level.h"
#include "server/core/network_address.h"

namespace furrow::server {

// Where to record streams, and when to begin the next file.
struct RecordConfig {
  std::filesystem::path folder;    // created if absent; empty: record nothing
  double rotate_megabytes = 1024;  // maximum file size; 0: no limit
  double rotate_seconds = 3600;    // maximum time span of a file; 0: no limit
  bool datagrams = true;           // also record the datagrams as received
  friend bool operator==(const RecordConfig&, const RecordConfig&) = default;
};

// Maximum of Config::threads; also the largest number of shards of a hub.
inline constexpr int kMaxThreads = 64;
// Maximum of Config::busy_poll_us: enough for 10 poses per second.
inline constexpr int kMaxBusyPollUs = 100'000;
inline constexpr double kMaxMegapixelsPerSecond = 1e6;

// The whole configuration of furrowd, from flags or a TOML file (furrow.example.toml lists every
// key).
struct Config {
  std::filesystem::path source;  // the file of --config that was read into this; empty: none
  // If both the character and the rig are empty, the default character is used.
  std::filesystem::path character;  // a package (.glb), or the name of a shipped character
  std::string skeleton_map;         // name or file; empty: the best match of the shipped maps
  std::string shape_map;            // the same for the names of blend shapes
  // A file or the name of a shipped rig. Without a character: weights only; else replaces its rig.
  std::filesystem::path rig;
  std::string bind = "127.0.0.1";  // numeric, IPv4 or IPv6
  bool open = false;               // lets everybody in who reaches an address beyond this computer
  SecurityConfig security;
  std::uint16_t tcp = 7400;  // 0: any free port; the ready line shows it
  std::uint16_t udp = 7401;
  std::vector<JitterRule> jitter;  // jitter buffers; later rules come first
  int threads = 1;  // threads that receive UDP, [1, kMaxThreads]; see docs/CAPACITY.md
  // How long these threads look for datagrams before they sleep, [0, kMaxBusyPollUs].
  int busy_poll_us = 0;
  bool render = true;
  bool require_render = false;            // fail if OpenGL is unavailable
  std::string render_device;              // see render::RendererOptions::device
  std::filesystem::path render_settings;  // TOML (render::LoadSettings); empty: the defaults
  int max_video_encoders = 8;             // viewers with H.264 at a time, [0, 1000]; 0: none
  // Pixels that are shaded for the pictures of one host, and of all hosts, in millions per second,
  // [0, kMaxMegapixelsPerSecond]; 0: without a limit. A single picture may exceed it.
  double max_host_megapixels_per_second = 1000.0;
  double max_megapixels_per_second = 0.0;
  std::optional<std::uint16_t> vmc;            // UDP port; absent: off
  std::optional<std::uint16_t> livelink_face;  // UDP port; absent: off
  std::vector<std::string> mocap_allow;        // numeric sender addresses; empty: any sender
  std::optional<HostPort> osc_out;             // absent: off
  std::string osc_prefix = "furrow";           // /<prefix>/<subject>/<wrinkle weight>
  OscConfig osc;                               // further targets
  RecordConfig record;
  HttpConfig http;
  ClusterConfig cluster;               // by default, the daemon is alone
  std::filesystem::path play;          // recording to play inside the daemon, a file or the
                                       // name of a shipped one; empty: none
  std::string bvh_positions = "auto";  // motion::ParseBvhPositions()
  std::string up_axis = "auto";        // motion::ParseUpAxis()
  int rest_frame = -1;                 // frame of `play` that is its rest pose; -1: the file's own
  LogLevel log_level = LogLevel::kInfo;
  bool verbose = false;   // print a status line every second
  bool log_json = false;  // log JSON objects instead of text
  Limits limits;
  friend bool operator==(const Config&, const Config&) = default;
};

// How recordings are read: --play and those of the rig's reference poses.
[[nodiscard]] motion::LoadOptions ReadOptions(const Config& config);
// The same for the recording that `play` names.
[[nodiscard]] motion::LoadOptions PlayOptions(const Config& config);

// Reads a TOML file, or the text of one, into `config`. Keys that it does not set keep their
// values. `source_name`: the file name in errors. After an error `config` may be partly changed.
//
// Errors: kNotFound, kIo, kParse, kSchema (unknown key, wrong type), kInvalidArgument (out of
// range); `where` is "file:line", the message names the key.
[[nodiscard]] Status LoadConfigFile(const std::filesystem::path& path, Config* config);
[[nodiscard]] Status ParseConfig(std::string_view toml, std::string_view source_name,
                                 Config* config);

// Where the file sets a key, "http.port" or the like: "file:line"; "file" if it does not.
[[nodiscard]] std::string PlaceOfKey(const std::filesystem::path& path, std::string_view key);

// True if programs on other computers can reach the daemon.
[[nodiscard]] bool ListensToNetwork(const Config& config);

// The first fault of a configuration.
struct ConfigFault {
  // The key of the file that has set the value, "listen.threads". Empty if several settings do not
  // fit together, or if a flag may have set the value.
  std::string_view key;
  Status status;  // kInvalidArgument; a message about one value begins with its flag or its key
};

// Checks values and their combination: addresses, ranges, conflicting ports and flags. Returns the
// first fault, if any. The result of ValidateConfig() is its status.
[[nodiscard]] std::optional<ConfigFault> FindFault(const Config& config);
[[nodiscard]] Status ValidateConfig(const Config& config);

// The result of parsing the command line. Without a config: print `text` (help or version if
// `exit_code` is kOk, else an error) and exit.
struct CommandLine {
  std::optional<Config> config;
  ExitCode exit_code = ExitCode::kOk;
  std::string text;
  bool check = false;  // only look for faults, see Check()
  // Errors are to be logged as JSON, as far as that is known. Use it for `text` without a config.
  bool log_json = false;
};

// Parses the command line of furrowd and the file of --config. Flags override the file, and the
// file overrides the defaults. `args`: without the program name.
[[nodiscard]] CommandLine ParseCommandLine(std::span<const std::string> args);

}  // namespace furrow::server
