// SPDX-License-Identifier: Apache-2.0
#include "server/config/config_entries.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include <spdlog/fmt/fmt.h>

#include "base/joined.h"
#include "server/config/settings.h"

namespace furrow::server {
namespace {

std::string Text(const std::string& value) { return value; }
std::string Text(const std::filesystem::path& value) { return value.string(); }
std::string Text(bool value) { return value ? "true" : "false"; }
std::string Text(int value) { return std::to_string(value); }
std::string Text(double value) { return fmt::format("{}", value); }
std::string Text(std::uint16_t value) { return std::to_string(value); }
std::string Text(Security value) { return value == Security::kRequired ? "required" : "open"; }
std::string Text(LogLevel value) { return std::string(LogLevelText(value)); }
std::string Text(const HostPort& value) { return HostPortText(value); }
std::string Text(const std::vector<std::string>& value) { return Joined(value); }
std::string Text(const std::vector<JitterRule>& rules) {
  return Joined(rules, [](const JitterRule& rule) {
    return rule.subjects + "=" + fmt::format("{}", rule.delay_ms);
  });
}
std::string Text(const std::vector<OscTargetConfig>& targets) {
  return Joined(targets, [](const OscTargetConfig& target) {
    return fmt::format("{} {} {} '{}' '{}' {}", HostPortText(target.to), target.profile,
                       target.prefix, target.subject, target.pattern, target.rate_hz);
  });
}
template <class T>
std::string Text(const std::optional<T>& value) {
  return value ? Text(*value) : std::string();
}

}  // namespace

std::vector<ConfigEntry> ConfigEntries(const Config& config) {
  std::vector<ConfigEntry> entries;
  VisitSettings(
      [&](const Setting& setting, const auto& value) {
        entries.push_back({setting.key, Text(value)});
      },
      config);
  return entries;
}

std::string ConfigSummary(const Config& config) {
  const std::vector<ConfigEntry> entries = ConfigEntries(config);
  const std::vector<ConfigEntry> defaults = ConfigEntries(Config());
  std::string summary;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].value == defaults[i].value) continue;
    summary += (summary.empty() ? "" : " ") + std::string(entries[i].key) + "=" + entries[i].value;
  }
  for (char& c : summary) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return summary.empty() ? "defaults" : summary;
}

}  // namespace furrow::server
