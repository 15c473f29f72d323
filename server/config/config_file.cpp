// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/files.h"
#include "base/status.h"
#include "server/config/config.h"

namespace furrow::server {
namespace {

// Far above any real file. --config may name a device or a file of the wrong kind.
constexpr std::uint64_t kMaxConfigBytes = 1 << 20;

// One key of a table. `assign` stores the value and returns an error, or an empty string.
struct Key {
  std::string_view name;
  std::function<std::string(const toml::node&)> assign;
};

// Each of these makes the key of one type. value_exact() converts nothing: 1.0 is not a port, and 1
// is not a flag.
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
            *target = folder / *value;  // an absolute path stays as it is
            return {};
          }};
}

// A name or a file. Values with a slash or the ending .json are files, relative to `folder`.
template <class Target>
Key NameOrFile(std::string_view name, Target* target, std::filesystem::path folder) {
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
            if (!value || *value < 0 || *value > 65535) return "must be a port number, 0 to 65535";
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
            // Whole numbers are valid numbers, so value() converts them; is_number() rules out
            // other types.
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

// The name of a table (empty: the top level of the file) and its keys.
using NamedKeys = std::pair<std::string_view, std::vector<Key>>;
using Tables = std::vector<NamedKeys>;

class Reader {
 public:
  // Reads a parsed file into the targets of the keys. Unknown names are errors, so that a typing
  // mistake is not silently ignored.
  Reader(std::string_view source_name) : source_name_(source_name) {}

  // Reads the top level, which is the first of `tables`, and then the other tables.
  Status ReadFile(const toml::table& root, std::span<const NamedKeys> tables) const {
    Status status = ReadTable(root, "", tables.front().second, tables.subspan(1));
    for (const auto& [name, keys] : tables.subspan(1)) {
      const toml::table* table = root[name].as_table();
      if (status.ok() && table != nullptr) {
        status = ReadTable(*table, std::string(name) + ".", keys, {});
      }
    }
    return status;
  }

 private:
  // `subtables`: names at this level that are tables, not keys.
  Status ReadTable(const toml::table& table, std::string_view prefix, std::span<const Key> keys,
                   std::span<const NamedKeys> subtables) const {
    for (const auto& [key, node] : table) {
      const std::string name = std::string(prefix) + std::string(key.str());
      const auto known = std::ranges::find(keys, key.str(), &Key::name);
      const auto subtable = std::ranges::find(subtables, key.str(), &NamedKeys::first);
      if (known != keys.end()) {
        if (std::string fault = known->assign(node); !fault.empty()) {
          return Error(StatusCode::kSchema, node, name + " " + fault);
        }
      } else if (subtable == subtables.end()) {
        return Error(StatusCode::kSchema, node, "unknown key '" + name + "'");
      } else if (!node.is_table()) {
        return Error(StatusCode::kSchema, node, name + " must be a table");
      }
    }
    return {};
  }

  // `where` is file and line, as compilers write it.
  Status Error(StatusCode code, const toml::node& node, std::string what) const {
    return Status(code, std::move(what),
                  std::string(source_name_) + ":" + std::to_string(node.source().begin.line));
  }

  std::string_view source_name_;
};

// The keys by table. Three functions, because the whole list is long.
Tables InputTables(Config* config, const std::filesystem::path& folder) {
  return {{"",
           {Path("character", &config->character, folder), NameOrFile("rig", &config->rig, folder),
            Path("play", &config->play, folder), Text("bvh_positions", &config->bvh_positions),
            Text("up_axis", &config->up_axis), Count("rest_frame", &config->rest_frame),
            NameOrFile("skeleton_map", &config->skeleton_map, folder),
            NameOrFile("shape_map", &config->shape_map, folder)}},
          {"listen",
           {Text("bind", &config->bind), Port("tcp", &config->tcp), Port("udp", &config->udp),
            Count("threads", &config->threads)}},
          {"mocap",
           {Port("vmc", &config->vmc), Port("livelink_face", &config->livelink_face),
            Texts("allow", &config->mocap_allow)}}};
}

Tables OutputTables(Config* config, const std::filesystem::path& folder) {
  RecordConfig& record = config->record;
  HttpConfig& http = config->http;
  return {
      {"render",
       {Flag("enabled", &config->render), Flag("required", &config->require_render),
        Text("device", &config->render_device),
        Path("settings", &config->render_settings, folder)}},
      {"osc", {Destination("out", &config->osc_out), Text("prefix", &config->osc_prefix)}},
      {"record",
       {Path("dir", &record.folder, folder), Number("rotate_megabytes", &record.rotate_megabytes),
        Number("rotate_seconds", &record.rotate_seconds), Flag("datagrams", &record.datagrams)}},
      {"http",
       {Flag("enabled", &http.enabled), Port("port", &http.port),
        Texts("allow_hosts", &http.allow_hosts), Texts("allow_origins", &http.allow_origins),
        Count("max_connections", &http.max_connections), Path("page", &http.page, folder)}},
      {"log", {Flag("verbose", &config->verbose), Flag("json", &config->log_json)}}};
}

Tables LimitTables(Limits* limits) {
  return {{"limits",
           {Count("max_connections", &limits->max_connections),
            Count("max_udp_peers", &limits->max_udp_peers),
            Count("max_subjects", &limits->max_subjects),
            Count("max_skeletons", &limits->max_skeletons),
            Count("max_subscriptions", &limits->max_subscriptions),
            Number("packets_per_second", &limits->packets_per_second),
            Number("packet_burst", &limits->packet_burst),
            Count("outbox_messages", &limits->outbox_messages),
            Number("idle_seconds", &limits->idle_seconds),
            Number("loss_seconds", &limits->loss_seconds),
            Number("drain_seconds", &limits->drain_seconds)}}};
}

}  // namespace

Status ParseConfig(std::string_view text, std::string_view source_name, Config* config) {
  toml::table root;
  try {
    root = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    // The parser of toml++ throws; the rest of the daemon uses Status.
    return Status(StatusCode::kParse, std::string(error.description()),
                  std::string(source_name) + ":" + std::to_string(error.source().begin.line));
  }
  // Reads into a copy, so that an error leaves `config` as it was.
  Config read = *config;
  // Paths in the file are relative to the file.
  const std::filesystem::path folder = std::filesystem::path(source_name).parent_path();
  Tables tables = InputTables(&read, folder);
  std::ranges::move(OutputTables(&read, folder), std::back_inserter(tables));
  std::ranges::move(LimitTables(&read.limits), std::back_inserter(tables));
  const Reader reader(source_name);
  Status status = reader.ReadFile(root, tables);
  if (status.ok()) *config = std::move(read);
  return status;
}

Status LoadConfigFile(const std::filesystem::path& path, Config* config) {
  const Result<std::string> text = ReadFile(path, kMaxConfigBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseConfig(*text, path.string(), config);
}

}  // namespace furrow::server
