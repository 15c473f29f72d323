// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/text.h"
#include "server/config/config.h"
#include "server/config/settings.h"

namespace furrow::server {
namespace {

constexpr char kVersion[] = "furrowd " FURROW_VERSION;

constexpr char kFooter[] = R"(
Port 0 selects any free port; the line 'furrowd ready ...' shows the ports.
Without --character and --rig, furrowd uses the default character from
$FURROW_DATA_DIR or from ../share/furrow beside the program. With --rig alone,
it sends weights and renders no pictures.

Exit codes: 0 stopped by SIGTERM or SIGINT, 1 failed at run time (for example a
port is in use, or OpenGL is required and unavailable), 2 wrong usage,
3 bad input (config, character, rig).)";

// Flags that are applied after the configuration file has been read.
struct Flags {
  std::string config_file;
  std::string osc_out;
  std::vector<std::string> jitter;
  bool no_render = false;
  bool no_http = false;
  bool check = false;
};

// Replaces the word of --security by its number, for CLI11. Returns what is wrong with it.
std::string NumberOfMode(std::string& text) {
  const auto mode = ParseSecurity(text);
  if (!mode) return "'" + text + "' is not one of open|required";
  text = std::to_string(static_cast<int>(*mode));
  return {};
}

// The same for --log-level.
std::string NumberOfLevel(std::string& text) {
  const auto level = ParseLogLevel(text);
  if (!level) return "'" + text + "' is not one of error|warning|info";
  text = std::to_string(static_cast<int>(*level));
  return {};
}

// For numbers: the error names the range.
CLI::Validator Within(const Range& range, const std::string& what) {
  return CLI::Validator(
      [range, what](std::string& text) {
        double number = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, number);
        if (is_number && Contains(range, number)) return std::string();
        std::ostringstream fault;
        fault << "'" << text << "' is not a " << what << " from " << range.least << " to "
              << range.most;
        return fault.str();
      },
      "");
}
CLI::Validator IsPort() { return Within(kPortNumber, "port"); }

// The message about words that furrowd does not know; empty if it knows all.
std::string UnknownWords(const CLI::App& app) {
  const std::vector<std::string> extra = app.remaining();
  if (extra.empty()) return {};
  const std::string word = extra.front().substr(0, extra.front().find('='));
  if (!word.starts_with('-')) {
    return "unexpected argument " + Quoted(word) + " ('furrowd --help' lists the options)\n";
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  return UnknownWord("option", word, known, "furrowd") + "\n";
}

// These declare flags on `config`, in the order of the help. Parsing writes only the flags that are
// present.
void DeclareFiles(CLI::App* app, Config* config, Flags* flags) {
  app->add_option("--config", flags->config_file,
                  "Read a TOML configuration file; flags override it");
  app->add_flag("--check", flags->check,
                "Read the configuration and all files that it names, say what is wrong or that it\n"
                "is valid, and exit");
  app->add_option(
      "--character", config->character,
      "Render this character and use its wrinkle rig: a package (.glb), or the name of\n"
      "a shipped character (default, elder)");
  app->add_option(
      "--rig", config->rig,
      "Use this wrinkle rig: a JSON file, or the name of a shipped rig (arkit, cmu, ...)");
  app->add_option("--skeleton-map", config->skeleton_map,
                  "Map joint names of streams with this map, by name or file\n"
                  "(default: the best match of the shipped maps)");
  app->add_option("--shape-map", config->shape_map,
                  "Map blend-shape names of streams with this map, by name or file\n"
                  "(default: the best match of the shipped maps)");
}

void DeclareAccess(CLI::App* app, Config* config) {
  app->add_option("--bind", config->bind,
                  "Listen on this address (default: 127.0.0.1); others need --security required\n"
                  "or --open");
  app->add_flag("--open", config->open,
                "Let everybody in who can reach the address of --bind: they may publish,\n"
                "watch and change settings (see docs/SECURITY.md)");
  app->add_option("--security", config->security.mode,
                  "open: clients need no token; required: everybody shows a token that\n"
                  "'furrow token new' made with a key of --keys (default: open)")
      ->transform(CLI::Validator(NumberOfMode, ""))
      ->type_name("open|required");
  app->add_option("--keys", config->security.keys,
                  "File with the keys of tokens, as 'furrow token key new' makes it; changes take\n"
                  "effect within a second");
  app->add_option("--name", config->security.name,
                  "Name of this daemon: tokens for another --audience are refused");
  app->add_flag("--tokens-in-clear", config->security.tokens_in_clear,
                "Accept tokens over TCP and HTTP from other computers. Everybody on the way can\n"
                "read them (default: from this computer only; over UDP and TLS from anywhere)");
  app->add_option(
         "--tls-certificate", config->security.tls.certificate,
         "Certificate of this daemon (PEM), with which the TCP port and the web port speak\n"
         "TLS only; changes take effect within two seconds (see docs/SECURITY.md)")
      ->type_name("FILE");
  app->add_option("--tls-key", config->security.tls.key,
                  "Private key of the certificate (PEM, without a passphrase)")
      ->type_name("FILE");
  app->add_option(
         "--tls-client-authority", config->security.tls.client_authority,
         "Let in only clients whose certificate one of these authorities (PEM) has signed\n"
         "(default: clients need no certificate)")
      ->type_name("FILE");
  app->add_flag_callback(
      "--no-confine", [config] { config->security.confine = false; },
      "Keep all privileges and the access to all files (default: give up what the\n"
      "daemon does not need; see docs/SECURITY.md)");
}

void DeclarePorts(CLI::App* app, Config* config, Flags* flags) {
  app->add_option("--tcp", config->tcp, "TCP port for poses, weights and pictures (default: 7400)")
      ->check(IsPort());
  app->add_option("--udp", config->udp, "UDP port for poses and weights (default: 7401)")
      ->check(IsPort());
  app->add_option(
         "--threads", config->threads,
         "Number of threads that receive UDP, 1 to 64; each sender is served by one of them\n"
         "(default: 1)")
      ->check(Within(kThreadCount, "number of threads"))
      ->type_name("N");
  app->add_option("--busy-poll", config->busy_poll_us,
                  "Look for UDP datagrams for US microseconds after the last ones before a thread\n"
                  "sleeps, which uses a whole core per thread and lowers the latency (default: 0)")
      ->check(Within(kBusyPollTime, "time in microseconds"))
      ->type_name("US");
  app->add_option(
         "--jitter-buffer", flags->jitter,
         "Hold poses of subjects for MS milliseconds, so that they leave in order and evenly\n"
         "although a network delays them unevenly; all subjects, or those of the globs SUBJECTS\n"
         "(repeatable; the last match counts; default: 0, off)")
      ->type_name("[SUBJECTS=]MS")
      ->allow_extra_args(false);
  app->add_option("--http", config->http.port,
                  "Port of the web page (default: 7480, or any free port if it is in use)")
      ->check(IsPort());
  app->add_option("--allow-host", config->http.allow_hosts,
                  "Name by which browsers and scrapers may address the web port, such as\n"
                  "furrow.example (repeatable; default: localhost and numeric addresses)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app->add_flag("--no-http", flags->no_http, "Disable the web page, WebSocket and HTTP API");
}

void DeclarePlayback(CLI::App* app, Config* config) {
  app->add_option("--play", config->play,
                  "Play this recording as a subject, with a timeline on the web page: a file, or\n"
                  "the name of a shipped recording (performance, walk, ...)");
  app->add_option("--bvh-positions", config->bvh_positions,
                  "Position channels of BVH joints: auto, channels, offsets or add\n"
                  "(default: auto; 'furrow convert --help' explains them)");
  app->add_option("--up-axis", config->up_axis,
                  "Axis that points up in BVH files: auto, y or z (default: auto)");
  app->add_option("--rest-frame", config->rest_frame,
                  "Frame of the --play recording to take as its rest pose, counted from 0;\n"
                  "the performer stands upright and faces +Z there (default: the file's own)")
      ->check(Within({.least = 0, .most = 1e9}, "frame"))
      ->type_name("N");
}

void DeclareRendering(CLI::App* app, Config* config, Flags* flags) {
  app->add_flag("--no-render", flags->no_render, "Send weights only; do not use OpenGL");
  app->add_flag("--require-render", config->require_render, "Exit with 1 if OpenGL is unavailable");
  app->add_option("--render-device", config->render_device,
                  "EGL device index or 'surfaceless' (default: the first with OpenGL 4.5)");
  app->add_option("--render-settings", config->render_settings,
                  "Read picture settings from a TOML file, as written by\n"
                  "'furrow render --print-settings'");
}

void DeclareMocapAndOsc(CLI::App* app, Config* config, Flags* flags) {
  app->add_option("--vmc", config->vmc,
                  "Receive VMC (OSC) on this UDP port, usually 39539 (default: off)")
      ->check(IsPort());
  app->add_option("--livelink-face", config->livelink_face,
                  "Receive Live Link Face on this UDP port, usually 11111 (default: off)")
      ->check(IsPort());
  app->add_option(
         "--mocap-allow", config->mocap_allow,
         "Accept --vmc and --livelink-face from this address only (repeatable). Each port\n"
         "accepts one sender until it has been silent for 3 s; with allowed addresses,\n"
         "--livelink-face accepts all of them at once (default: any address)")
      ->type_name("ADDRESS")
      ->allow_extra_args(false);
  app->add_option("--osc-out", flags->osc_out,
                  "Send all weights as OSC to this HOST:PORT (default: off)");
  app->add_option("--osc-prefix", config->osc_prefix,
                  "First part of the OSC addresses (default: furrow)");
}

void DeclareRecording(CLI::App* app, Config* config) {
  app->add_option("--record", config->record.folder,
                  "Record all streams to MCAP files in this folder (default: off)");
  app->add_option("--record-rotate-megabytes", config->record.rotate_megabytes,
                  "Start a new file at this size in MB (default: 1024; 0: never)")
      ->check(Within(kRotation, "size"));
  app->add_option("--record-rotate-seconds", config->record.rotate_seconds,
                  "Start a new file after this time in seconds (default: 3600; 0: never)")
      ->check(Within(kRotation, "time"));
}

void DeclareCluster(CLI::App* app, Config* config) {
  app->add_option("--cluster", config->cluster.store,
                  "Share subjects with the daemons that use this NATS server: nats://HOST:PORT or\n"
                  "tls://HOST:PORT; needs --name (default: alone; see docs/CLUSTER.md)")
      ->type_name("URL");
  app->add_option("--cluster-advertise", config->cluster.advertise,
                  "Host by which clients reach this daemon (default: the address of --bind)")
      ->type_name("HOST");
  app->add_option("--cluster-credentials", config->cluster.credentials,
                  "File with user:password for the NATS server, or a .creds file of NATS")
      ->type_name("FILE");
  app->add_option("--cluster-node", config->cluster.nodes,
                  "Share subjects with these daemons, without NATS: NAME=HOST[:TCP:UDP:HTTP]\n"
                  "(repeatable; all daemons get the same list)")
      ->type_name("NODE")
      ->allow_extra_args(false);
  app->add_flag("--cluster-strict", config->cluster.strict,
                "Stop serving after 2 s without the NATS server (default: go on with what is\n"
                "served, and take nothing new)");
}

void DeclareLog(CLI::App* app, Config* config) {
  app->add_option("--log-level", config->log_level,
                  "Log these lines and more important ones (default: info)")
      ->transform(CLI::Validator(NumberOfLevel, ""))
      ->type_name("error|warning|info");
  app->add_flag("--verbose", config->verbose, "Print a status line every second");
  app->add_flag("--log-json", config->log_json, "Write log lines as JSON");
}

void Declare(CLI::App* app, Config* config, Flags* flags) {
  DeclareFiles(app, config, flags);
  DeclareAccess(app, config);
  DeclarePorts(app, config, flags);
  DeclarePlayback(app, config);
  DeclareRendering(app, config, flags);
  DeclareMocapAndOsc(app, config, flags);
  DeclareRecording(app, config);
  DeclareCluster(app, config);
  DeclareLog(app, config);
}

// Applies the flags that are more than a value, after the file has been read.
Status Apply(const Flags& flags, Config* config) {
  if (flags.no_render) config->render = false;
  if (flags.no_http) config->http.enabled = false;
  if (!flags.jitter.empty()) config->jitter.clear();
  for (const std::string& text : flags.jitter) {
    const Result<JitterRule> rule = ParseJitterRule(text);
    if (!rule.ok()) return rule.status().At("--jitter-buffer");
    config->jitter.push_back(*rule);
  }
  if (!flags.osc_out.empty()) {
    Result<HostPort> destination = ParseHostPort(flags.osc_out);
    if (!destination.ok()) return destination.status().At("--osc-out");
    config->osc_out = *std::move(destination);
  }
  return {};
}

// Without a config: the program prints the text and ends.
CommandLine Fail(ExitCode code, const std::string& text) { return {std::nullopt, code, text}; }

// CLI11 parses a vector from its back.
std::vector<std::string> Reversed(std::span<const std::string> args) {
  return {args.rbegin(), args.rend()};
}

}  // namespace

CommandLine ParseCommandLine(std::span<const std::string> args) {
  Config config;
  Flags flags;
  // A wrong option before the flag would hide it from the parser.
  const bool wants_json = std::ranges::find(args, std::string_view("--log-json")) != args.end();
  const auto fail = [&](ExitCode code, const std::string& text) {
    CommandLine line = Fail(code, text);
    line.log_json = wants_json || config.log_json;
    return line;
  };
  CLI::App first("Compute wrinkle weights and pictures from live poses.", "furrowd");
  first.footer(kFooter);
  first.set_version_flag("--version", kVersion);
  Declare(&first, &config, &flags);
  try {
    first.parse(Reversed(args));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    // CLI11 reports --help and --version as exceptions, too; exit() writes their text and returns
    // 0.
    const bool failed = first.exit(error, out, out) != 0;
    if (std::string unknown = UnknownWords(first); failed && !unknown.empty()) {
      return fail(ExitCode::kUsage, unknown);
    }
    return fail(failed ? ExitCode::kUsage : ExitCode::kOk, out.str());
  }
  if (first.count("--config") > 0 && flags.config_file.empty()) {
    return fail(ExitCode::kUsage, "--config: the name of the file is empty\n");
  }
  if (!flags.config_file.empty()) {
    // Flags override the file: read the file into a fresh config, then parse the flags again.
    config = Config();
    if (Status status = LoadConfigFile(flags.config_file, &config); !status.ok()) {
      return fail(ExitCode::kBadInput, status.ToString() + "\n");
    }
    config.source = flags.config_file;
    CLI::App second;
    Declare(&second, &config, &flags);
    // Does not throw: the first pass has accepted the same arguments.
    second.parse(Reversed(args));
  }
  if (const Status status = Apply(flags, &config); !status.ok()) {
    return fail(ExitCode::kUsage, status.ToString() + "\n");
  }
  if (const auto fault = FindFault(config)) {
    if (flags.config_file.empty()) return fail(ExitCode::kUsage, fault->status.ToString() + "\n");
    // The values may come from either. With a file, the error names it.
    const std::string place = PlaceOfKey(flags.config_file, fault->key);
    return fail(ExitCode::kBadInput, fault->status.At(place).ToString() + "\n");
  }
  return {config, ExitCode::kOk, {}, flags.check, config.log_json};
}

}  // namespace furrow::server
