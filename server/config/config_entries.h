// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/config/config.h"

namespace furrow::server {

// A key of the configuration and its value, for people and for comparison.
struct ConfigEntry {
  std::string_view key;  // as in TOML: "listen.tcp"
  std::string value;     // as TOML writes it, but short; empty: not set
};

// Every key that furrow.example.toml lists, in its order. Secrets are not among them: the
// configuration only names their files.
[[nodiscard]] std::vector<ConfigEntry> ConfigEntries(const Config& config);

// The keys that differ from the defaults, for the log: "listen.tcp=0 render.enabled=false", or
// "defaults". Control characters in values become '?'.
[[nodiscard]] std::string ConfigSummary(const Config& config);

}  // namespace furrow::server
