// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>

#include "server/config/config.h"

namespace furrow::server {
namespace {

constexpr char kVersion[] = "furrowd " FURROW_VERSION;

constexpr char kFooter[] = R"(
Ports may be 0: any free one; the line 'furrowd ready ...' says which.
Without --character and --rig: the default character of $FURROW_DATA_DIR, else
of ../share/furrow beside the program. With --rig alone: weights, no pictures.

Exit codes: 0 stopped by SIGTERM or SIGINT, 1 failed at run time (a port is
taken, GL is required and absent), 2 wrong usage, 3 bad input (config,
character, rig).)";

// What only flags can say until the file of --config is read under them.
struct Flags {
  std::string config_file;
  std::string osc_out;
  bool no_render = false;
  bool no_http = false;
};

// Declares every flag on `config`; parsing writes only those that were given.
void Declare(CLI::App* app, Config* config, Flags* flags) {
  app->add_option("--config", flags->config_file, "TOML file; flags win over it");
  app->add_option("--character", config->character, "what is drawn (.glb), with its wrinkle rig");
  app->add_option("--rig", config->rig, "wrinkle rig (JSON)");
  app->add_option("--skeleton-map", config->skeleton_map,
                  "what streams call their joints: a map's name or file (the best that ships)");
  app->add_option("--bind", config->bind, "address to listen on (default 127.0.0.1)");
  app->add_option("--tcp", config->tcp, "TCP port: poses in, weights and pictures out (7400)");
  app->add_option("--udp", config->udp, "UDP port: poses in, weights out (7401)");
  app->add_option("--threads", config->threads,
                  "threads that take in UDP, each its share of the senders (1)")
      ->type_name("N");
  app->add_option("--http", config->http.port,
                  "port of the page (7480, or any free one where that is taken; 0: any)");
  app->add_flag("--no-http", flags->no_http, "no page, no WebSocket, no JSON");
  app->add_option("--play", config->play,
                  "recording that plays inside the daemon, with a timeline on the page (none)");
  app->add_flag("--no-render", flags->no_render, "weights only, no GL");
  app->add_flag("--require-render", config->require_render, "end (1) where GL cannot be had");
  app->add_option("--render-device", config->render_device,
                  "EGL device index or 'surfaceless' (the first that gives OpenGL 4.5)");
  app->add_option(
      "--render-settings", config->render_settings,
      "TOML of the pictures' appearance, as 'furrow render --print-settings' writes it");
  app->add_option("--vmc", config->vmc, "UDP port for VMC over OSC (none; 39539 is usual)");
  app->add_option("--livelink-face", config->livelink_face,
                  "UDP port for Live Link Face (none; 11111 is usual)");
  app->add_option("--mocap-allow", config->mocap_allow,
                  "address that may send to those two, again for more (none: the first to come,\n"
                  "until it is silent for 3 s; with them, --livelink-face takes all at once)")
      ->type_name("ADDRESS")
      ->allow_extra_args(false);
  app->add_option("--osc-out", flags->osc_out, "HOST:PORT that gets the weights as OSC (none)");
  app->add_option("--osc-prefix", config->osc_prefix, "first part of the OSC addresses (furrow)");
  app->add_option("--record", config->record.folder,
                  "folder to record everything to, as MCAP files (none); see docs/RECORDING.md");
  app->add_option("--record-rotate-megabytes", config->record.rotate_megabytes,
                  "the next file begins at this size (1024; 0: never)");
  app->add_option("--record-rotate-seconds", config->record.rotate_seconds,
                  "and when a file covers so much time (3600; 0: never)");
  app->add_flag("--verbose", config->verbose, "one status line a second");
  app->add_flag("--log-json", config->log_json, "log lines as JSON");
}

CommandLine Fail(ExitCode code, const std::string& text) { return {std::nullopt, code, text}; }

// CLI11 parses from the back of a vector, and takes it by value.
std::vector<std::string> Reversed(std::span<const std::string> args) {
  return {args.rbegin(), args.rend()};
}

}  // namespace

CommandLine ParseCommandLine(std::span<const std::string> args) {
  Config config;
  Flags flags;
  CLI::App first("Turns live poses into wrinkle weights and pictures.", "furrowd");
  first.footer(kFooter);
  first.set_version_flag("--version", kVersion);
  Declare(&first, &config, &flags);
  try {
    first.parse(Reversed(args));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    const bool failed = first.exit(error, out, out) != 0;
    return Fail(failed ? ExitCode::kUsage : ExitCode::kOk, out.str());
  }
  if (!flags.config_file.empty()) {
    // The file comes under the flags: it is read into a fresh config, and the flags once more over
    // it.
    config = Config();
    if (Status status = LoadConfigFile(flags.config_file, &config); !status.ok()) {
      return Fail(ExitCode::kBadInput, status.ToString() + "\n");
    }
    CLI::App second;
    Declare(&second, &config, &flags);
    second.parse(Reversed(args));
  }
  if (flags.no_render) config.render = false;
  if (flags.no_http) config.http.enabled = false;
  if (!flags.osc_out.empty()) {
    Result<HostPort> destination = ParseHostPort(flags.osc_out);
    if (!destination.ok()) {
      return Fail(ExitCode::kUsage, destination.status().At("--osc-out").ToString() + "\n");
    }
    config.osc_out = *std::move(destination);
  }
  if (Status status = ValidateConfig(config); !status.ok()) {
    const bool by_file = !flags.config_file.empty();
    return Fail(by_file ? ExitCode::kBadInput : ExitCode::kUsage,
                (by_file ? status.At(flags.config_file) : status).ToString() + "\n");
  }
  return {config, ExitCode::kOk, {}};
}

}  // namespace furrow::server
