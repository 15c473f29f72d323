// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <sstream>
#include <utility>

#include <toml++/toml.h>

#include "server/config.h"

namespace furrow::server {
namespace {

// One key of a table and what to do with its value; `assign` returns what is wrong, empty when
// fine.
struct Key {
  std::string_view name;
  std::function<std::string(const toml::node&)> assign;
};

Key Text(std::string_view name, std::string* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            *target = *value;
            return {};
          }};
}

Key Path(std::string_view name, std::filesystem::path* target, std::filesystem::path folder) {
  return {name, [target, folder = std::move(folder)](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            *target = folder / *value;  // an absolute path replaces the folder
            return {};
          }};
}

// A name as it stands; what looks like a file is relative to `folder`.
Key NameOrFile(std::string_view name, std::string* target, std::filesystem::path folder) {
  return {name, [target, folder = std::move(folder)](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            const bool file = value->find('/') != std::string::npos || value->ends_with(".json");
            *target = file ? (folder / *value).string() : *value;
            return {};
          }};
}

Key Flag(std::string_view name, bool* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<bool>();
            if (!value) return "must be true or false";
            *target = *value;
            return {};
          }};
}

template <class Target>
Key Port(std::string_view name, Target* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::int64_t>();
            if (!value || *value < 0 || *value > 65535) return "must be a port, 0 to 65535";
            *target = static_cast<std::uint16_t>(*value);
            return {};
          }};
}

Key Count(std::string_view name, int* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::int64_t>();
            if (!value || !std::in_range<int>(*value)) return "must be a whole number";
            *target = static_cast<int>(*value);
            return {};
          }};
}

Key Number(std::string_view name, double* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value<double>();
            if (!node.is_number() || !value) return "must be a number";
            *target = *value;
            return {};
          }};
}

Key Destination(std::string_view name, std::optional<HostPort>* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string, HOST:PORT";
            const Result<HostPort> parsed = ParseHostPort(*value);
            if (!parsed.ok()) return parsed.status().what();
            *target = *parsed;
            return {};
          }};
}

Key Texts(std::string_view name, std::vector<std::string>* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const toml::array* list = node.as_array();
            if (list == nullptr) return "must be a list of strings";
            std::vector<std::string> texts;
            for (const toml::node& element : *list) {
              const auto value = element.value_exact<std::string>();
              if (!value) return "must be a list of strings";
              texts.push_back(*value);
            }
            *target = std::move(texts);
            return {};
          }};
}

class Reader {
 public:
  Reader(std::string_view source_name) : source_name_(source_name) {}

  Status ReadTable(const toml::table& table, std::string_view prefix, std::span<const Key> keys,
                   std::initializer_list<std::string_view> subtables = {}) const {
    for (const auto& [key, node] : table) {
      const std::string name = std::string(prefix) + std::string(key.str());
      const auto is_named = [&](const Key& known) { return known.name == key.str(); };
      const auto known = std::find_if(keys.begin(), keys.end(), is_named);
      if (known != keys.end()) {
        if (std::string fault = known->assign(node); !fault.empty()) {
          return Error(StatusCode::kSchema, node, name + " " + fault);
        }
      } else if (std::find(subtables.begin(), subtables.end(), key.str()) != subtables.end()) {
        if (!node.is_table()) return Error(StatusCode::kSchema, node, name + " must be a table");
      } else {
        return Error(StatusCode::kSchema, node, "unknown key " + name);
      }
    }
    return {};
  }

 private:
  Status Error(StatusCode code, const toml::node& node, std::string what) const {
    return Status(code, std::move(what),
                  std::string(source_name_) + ":" + std::to_string(node.source().begin.line));
  }

  std::string_view source_name_;
};

}  // namespace

Status ParseConfig(std::string_view text, std::string_view source_name, Config* config) {
  toml::table root;
  try {
    root = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    return Status(StatusCode::kParse, std::string(error.description()),
                  std::string(source_name) + ":" + std::to_string(error.source().begin.line));
  }
  Config read = *config;
  const std::filesystem::path folder = std::filesystem::path(source_name).parent_path();
  const Key top[] = {Path("character", &read.character, folder), Path("rig", &read.rig, folder),
                     Path("play", &read.play, folder),
                     NameOrFile("skeleton_map", &read.skeleton_map, folder)};
  const Key listen[] = {Text("bind", &read.bind), Port("tcp", &read.tcp), Port("udp", &read.udp)};
  const Key render[] = {Flag("enabled", &read.render), Flag("required", &read.require_render),
                        Text("device", &read.render_device),
                        Path("settings", &read.render_settings, folder)};
  const Key mocap[] = {Port("vmc", &read.vmc), Port("livelink_face", &read.livelink_face),
                       Texts("allow", &read.mocap_allow)};
  const Key osc[] = {Destination("out", &read.osc_out), Text("prefix", &read.osc_prefix)};
  RecordConfig& record_of = read.record;
  const Key record[] = {Path("dir", &record_of.folder, folder),
                        Number("rotate_megabytes", &record_of.rotate_megabytes),
                        Number("rotate_seconds", &record_of.rotate_seconds),
                        Flag("datagrams", &record_of.datagrams)};
  HttpConfig& http_of = read.http;
  const Key http[] = {Flag("enabled", &http_of.enabled),
                      Port("port", &http_of.port),
                      Texts("allow_hosts", &http_of.allow_hosts),
                      Texts("allow_origins", &http_of.allow_origins),
                      Count("max_connections", &http_of.max_connections),
                      Path("page", &http_of.page, folder)};
  const Key log[] = {Flag("verbose", &read.verbose), Flag("json", &read.log_json)};
  Limits& limits_of = read.limits;
  const Key limits[] = {Count("max_connections", &limits_of.max_connections),
                        Count("max_udp_peers", &limits_of.max_udp_peers),
                        Count("max_subjects", &limits_of.max_subjects),
                        Count("max_skeletons", &limits_of.max_skeletons),
                        Count("max_subscriptions", &limits_of.max_subscriptions),
                        Number("packets_per_second", &limits_of.packets_per_second),
                        Number("packet_burst", &limits_of.packet_burst),
                        Count("outbox_messages", &limits_of.outbox_messages),
                        Number("idle_seconds", &limits_of.idle_seconds),
                        Number("loss_seconds", &limits_of.loss_seconds),
                        Number("drain_seconds", &limits_of.drain_seconds)};
  const std::pair<std::string_view, std::span<const Key>> tables[] = {
      {"listen", listen}, {"render", render}, {"mocap", mocap}, {"osc", osc},
      {"record", record}, {"http", http},     {"log", log},     {"limits", limits}};

  const Reader reader(source_name);
  Status status = reader.ReadTable(
      root, "", top, {"listen", "render", "mocap", "osc", "record", "http", "log", "limits"});
  for (const auto& [name, keys] : tables) {
    const toml::table* table = root[name].as_table();
    if (status.ok() && table != nullptr) {
      status = reader.ReadTable(*table, std::string(name) + ".", keys);
    }
  }
  if (status.ok()) *config = std::move(read);
  return status;
}

Status LoadConfigFile(const std::filesystem::path& path, Config* config) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Status(std::filesystem::exists(path) ? StatusCode::kIo : StatusCode::kNotFound,
                  "cannot read the config file", path.string());
  }
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad() || text.bad()) {
    return Status(StatusCode::kIo, "cannot read the config file", path.string());
  }
  return ParseConfig(text.str(), path.string(), config);
}

}  // namespace furrow::server
