// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/files.h"
#include "base/status.h"
#include "server/config/config.h"
#include "server/config/settings.h"
#include "server/config/toml_file.h"

namespace furrow::server {
namespace {

// Far above any real file. --config may name a device or a file of the wrong kind.
constexpr std::uint64_t kMaxConfigBytes = 1 << 20;

using toml_file::Key;

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
              const Key keys[] = {
                  Destination("to", &target.to),
                  toml_file::NameOrFile("profile", ".toml", &target.profile, folder),
                  toml_file::Text("prefix", &target.prefix),
                  toml_file::Text("subject", &target.subject),
                  toml_file::Text("pattern", &target.pattern),
                  toml_file::Number("rate_hz", &target.rate_hz)};
              const std::string number = std::to_string(targets->size() + 1);
              std::string fault = toml_file::ReadTable(element, keys);
              if (fault.empty() && target.to.port == 0) fault = "needs the key 'to'";
              if (!fault.empty()) return "number " + number + ": " + fault;
              targets->push_back(std::move(target));
            }
            return {};
          }};
}

// Makes the key of one setting, which reads what the type of the field asks for.
struct KeyMaker {
  std::string_view name;  // without the table
  Naming naming;
  const std::filesystem::path& folder;

  Key operator()(bool* field) const { return toml_file::Flag(name, field); }
  Key operator()(int* field) const { return toml_file::Count(name, field); }
  Key operator()(double* field) const { return toml_file::Number(name, field); }
  Key operator()(std::uint16_t* field) const { return toml_file::Port(name, field); }
  Key operator()(std::optional<std::uint16_t>* field) const { return toml_file::Port(name, field); }
  Key operator()(std::vector<std::string>* field) const { return toml_file::Texts(name, field); }
  Key operator()(std::string* field) const {
    return naming == Naming::kJson ? toml_file::NameOrFile(name, ".json", field, folder)
                                   : toml_file::Text(name, field);
  }
  Key operator()(std::filesystem::path* field) const {
    switch (naming) {
      case Naming::kShipped: return Shipped(name, field, folder);
      case Naming::kJson: return toml_file::NameOrFile(name, ".json", field, folder);
      case Naming::kPath: break;
    }
    return toml_file::Path(name, field, folder);
  }
  Key operator()(std::optional<HostPort>* field) const { return Destination(name, field); }
  Key operator()(std::vector<JitterRule>* field) const { return JitterRules(name, field); }
  Key operator()(Security* field) const { return Mode(name, field); }
  Key operator()(LogLevel* field) const { return Level(name, field); }
  Key operator()(std::vector<OscTargetConfig>* field) const {
    return OscTargets(name, field, folder);
  }
};

// The settings by table: "listen.tcp" is the key "tcp" of the table "listen".
toml_file::Tables TablesOf(Config* config, const std::filesystem::path& folder) {
  toml_file::Tables tables = {{"", {}}};
  const auto add = [&](const Setting& setting, auto& field) {
    const std::size_t dot = setting.key.find('.');
    const bool is_top_level = dot == std::string_view::npos;
    const std::string_view table = is_top_level ? "" : setting.key.substr(0, dot);
    const std::string_view name = is_top_level ? setting.key : setting.key.substr(dot + 1);
    if (tables.back().first != table) tables.push_back({table, {}});
    tables.back().second.push_back(KeyMaker{name, setting.naming, folder}(&field));
  };
  VisitSettings(add, *config);
  return tables;
}

}  // namespace

Status ParseConfig(std::string_view text, std::string_view source_name, Config* config) {
  // Reads into a copy, so that an error leaves `config` as it was.
  Config read = *config;
  // Paths in the file are relative to the file.
  const std::filesystem::path folder = std::filesystem::path(source_name).parent_path();
  Status status = toml_file::ReadText(text, source_name, TablesOf(&read, folder));
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
