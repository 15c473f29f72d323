// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/files.h"
#include "base/status.h"
#include "server/config/config.h"
#include "server/config/toml_file.h"

namespace furrow::server {
namespace {

// Far above any real file. --config may name a device or a file of the wrong kind.
constexpr std::uint64_t kMaxConfigBytes = 1 << 20;

using toml_file::Count;
using toml_file::Flag;
using toml_file::Key;
using toml_file::NameOrFile;
using toml_file::Number;
using toml_file::Path;
using toml_file::Port;
using toml_file::Tables;
using toml_file::Text;
using toml_file::Texts;

// A HOST:PORT with a numeric host.
template <class Target>
Key Destination(std::string_view name, Target* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string, HOST:PORT";
            const Result<HostPort> parsed = ParseHostPort(*value);
            if (!parsed.ok()) return parsed.status().what();
            *target = *parsed;
            return {};
          }};
}

// A recording or a character: the name of a shipped one, or a file relative to `folder`, which has
// a dot or a slash.
Key Shipped(std::string_view name, std::filesystem::path* target,
            const std::filesystem::path& folder) {
  return {name, [target, folder](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            *target = value->find_first_of("./") == value->npos ? std::filesystem::path(*value)
                                                                : folder / *value;
            return {};
          }};
}

// Rules of jitter buffers, each as after --jitter-buffer.
Key JitterRules(std::string_view name, std::vector<JitterRule>* rules) {
  return {name, [rules](const toml::node& node) -> std::string {
            const toml::array* list = node.as_array();
            if (list == nullptr) return "must be a list of strings, MS or SUBJECTS=MS";
            rules->clear();
            for (const toml::node& element : *list) {
              const auto rule = ParseJitterRule(element.value_exact<std::string>().value_or(""));
              if (!rule.ok()) return rule.status().what();
              rules->push_back(*rule);
            }
            return {};
          }};
}

// "open" or "required".
Key Mode(std::string_view name, Security* mode) {
  return {name, [mode](const toml::node& node) -> std::string {
            const auto value = ParseSecurity(node.value_exact<std::string>().value_or(""));
            if (!value) return "must be \"open\" or \"required\"";
            *mode = *value;
            return {};
          }};
}

// "error", "warning" or "info".
Key Level(std::string_view name, LogLevel* level) {
  return {name, [level](const toml::node& node) -> std::string {
            const auto value = ParseLogLevel(node.value_exact<std::string>().value_or(""));
            if (!value) return "must be \"error\", \"warning\" or \"info\"";
            *level = *value;
            return {};
          }};
}

// [[osc.target]]
Key OscTargets(std::string_view name, std::vector<OscTargetConfig>* targets,
               const std::filesystem::path& folder) {
  return {name, [targets, folder](const toml::node& node) -> std::string {
            const toml::array* list = node.as_array();
            if (list == nullptr) return "must be a list of tables: [[osc.target]]";
            targets->clear();
            for (const toml::node& element : *list) {
              OscTargetConfig target;
              const Key keys[] = {Destination("to", &target.to),
                                  NameOrFile("profile", ".toml", &target.profile, folder),
                                  Text("prefix", &target.prefix),
                                  Text("subject", &target.subject),
                                  Text("pattern", &target.pattern),
                                  Number("rate_hz", &target.rate_hz)};
              const std::string number = std::to_string(targets->size() + 1);
              std::string fault = toml_file::ReadTable(element, keys);
              if (fault.empty() && target.to.port == 0) fault = "needs the key 'to'";
              if (!fault.empty()) return "number " + number + ": " + fault;
              targets->push_back(std::move(target));
            }
            return {};
          }};
}

// The keys by table. Three functions, because the whole list is long.
Tables InputTables(Config* config, const std::filesystem::path& folder) {
  return {{"",
           {Shipped("character", &config->character, folder),
            NameOrFile("rig", ".json", &config->rig, folder),
            Shipped("play", &config->play, folder), Text("bvh_positions", &config->bvh_positions),
            Text("up_axis", &config->up_axis), Count("rest_frame", &config->rest_frame),
            NameOrFile("skeleton_map", ".json", &config->skeleton_map, folder),
            NameOrFile("shape_map", ".json", &config->shape_map, folder)}},
          {"listen",
           {Text("bind", &config->bind), Flag("open", &config->open), Port("tcp", &config->tcp),
            Port("udp", &config->udp), Count("threads", &config->threads),
            Count("busy_poll_us", &config->busy_poll_us),
            JitterRules("jitter_buffer", &config->jitter)}},
          {"security",
           {Mode("mode", &config->security.mode), Path("keys", &config->security.keys, folder),
            Text("name", &config->security.name),
            Flag("tokens_in_clear", &config->security.tokens_in_clear),
            Flag("confine", &config->security.confine)}},
          {"tls",
           {Path("certificate", &config->security.tls.certificate, folder),
            Path("key", &config->security.tls.key, folder),
            Path("client_authority", &config->security.tls.client_authority, folder)}},
          {"mocap",
           {Port("vmc", &config->vmc), Port("livelink_face", &config->livelink_face),
            Texts("allow", &config->mocap_allow)}}};
}

Tables OutputTables(Config* config, const std::filesystem::path& folder) {
  RecordConfig& record = config->record;
  HttpConfig& http = config->http;
  ClusterConfig& cluster = config->cluster;
  return {
      {"render",
       {Flag("enabled", &config->render), Flag("required", &config->require_render),
        Text("device", &config->render_device), Path("settings", &config->render_settings, folder),
        Count("max_video_encoders", &config->max_video_encoders),
        Number("max_host_megapixels_per_second", &config->max_host_megapixels_per_second),
        Number("max_megapixels_per_second", &config->max_megapixels_per_second)}},
      {"osc",
       {Destination("out", &config->osc_out), Text("prefix", &config->osc_prefix),
        OscTargets("target", &config->osc.targets, folder), Texts("allow", &config->osc.allow)}},
      {"record",
       {Path("dir", &record.folder, folder), Number("rotate_megabytes", &record.rotate_megabytes),
        Number("rotate_seconds", &record.rotate_seconds), Flag("datagrams", &record.datagrams)}},
      {"http",
       {Flag("enabled", &http.enabled), Port("port", &http.port),
        Texts("allow_hosts", &http.allow_hosts), Texts("allow_origins", &http.allow_origins),
        Count("max_connections", &http.max_connections), Path("page", &http.page, folder),
        Number("api_share", &http.api_share),
        Count("requests_per_second", &http.requests_per_second),
        Count("max_upload_megabytes", &http.max_upload_megabytes)}},
      {"cluster",
       {Text("store", &cluster.store), Texts("nodes", &cluster.nodes),
        Text("bucket", &cluster.bucket), Text("advertise", &cluster.advertise),
        Path("credentials", &cluster.credentials, folder),
        Path("authority", &cluster.authority, folder), Flag("strict", &cluster.strict)}},
      {"log",
       {Level("level", &config->log_level), Flag("verbose", &config->verbose),
        Flag("json", &config->log_json)}}};
}

Tables LimitTables(Limits* limits) {
  return {{"limits",
           {Count("max_connections", &limits->max_connections),
            Count("max_udp_peers", &limits->max_udp_peers),
            Count("max_subjects", &limits->max_subjects),
            Count("max_skeletons", &limits->max_skeletons),
            Count("max_subscriptions", &limits->max_subscriptions),
            Count("max_all_subscriptions", &limits->max_all_subscriptions),
            Number("packets_per_second", &limits->packets_per_second),
            Number("packet_burst", &limits->packet_burst),
            Count("max_waiting_megabytes", &limits->max_waiting_megabytes),
            Count("outbox_messages", &limits->outbox_messages),
            Number("idle_seconds", &limits->idle_seconds),
            Number("loss_seconds", &limits->loss_seconds),
            Number("drain_seconds", &limits->drain_seconds)}}};
}

}  // namespace

Status ParseConfig(std::string_view text, std::string_view source_name, Config* config) {
  // Reads into a copy, so that an error leaves `config` as it was.
  Config read = *config;
  // Paths in the file are relative to the file.
  const std::filesystem::path folder = std::filesystem::path(source_name).parent_path();
  Tables tables = InputTables(&read, folder);
  std::ranges::move(OutputTables(&read, folder), std::back_inserter(tables));
  std::ranges::move(LimitTables(&read.limits), std::back_inserter(tables));
  Status status = toml_file::ReadText(text, source_name, tables);
  if (status.ok()) *config = std::move(read);
  return status;
}

Status LoadConfigFile(const std::filesystem::path& path, Config* config) {
  const Result<std::string> text = ReadFile(path, kMaxConfigBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseConfig(*text, path.string(), config);
}

std::string PlaceOfKey(const std::filesystem::path& path, std::string_view key) {
  const Result<std::string> text = ReadFile(path, kMaxConfigBytes);
  const int line = text.ok() ? toml_file::LineOf(*text, key) : 0;
  return line == 0 ? path.string() : path.string() + ":" + std::to_string(line);
}

}  // namespace furrow::server
