// SPDX-License-Identifier: Apache-2.0
#include "server/config/config_entries.h"

#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

// The keys of furrow.example.toml, those in comments among them.
std::vector<std::string> KeysOfTheExample() {
  std::ifstream file(FURROW_SOURCE_DIR "/server/furrow.example.toml");
  const std::regex table(R"(^(?:# )?\[+([a-z.]+)\]+.*)");
  const std::regex key(R"(^(?:# )?([a-z_]+) = .*)");
  std::vector<std::string> keys;
  std::string prefix;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, table)) {
      prefix = match[1].str() + ".";
      if (prefix == "osc.target.") keys.emplace_back("osc.target");
    } else if (prefix != "osc.target." && std::regex_match(line, match, key)) {
      keys.push_back(prefix + match[1].str());
    }
  }
  return keys;
}

TEST(ConfigEntries, HasEveryKeyOfTheExample) {
  std::vector<std::string> keys;
  for (const ConfigEntry& entry : ConfigEntries(Config())) keys.emplace_back(entry.key);
  const std::vector<std::string> example = KeysOfTheExample();
  EXPECT_GT(example.size(), 50u);
  EXPECT_THAT(keys, testing::IsSupersetOf(example));
  // Read, but too rare to be shown there.
  for (const char* more : {"up_axis", "rest_frame"}) EXPECT_THAT(keys, testing::Contains(more));
}

TEST(ConfigSummary, NamesWhatIsNotTheDefault) {
  EXPECT_EQ(ConfigSummary(Config()), "defaults");
  Config config;
  config.tcp = 0;
  config.render = false;
  config.http.allow_hosts = {"a", "b"};
  config.jitter = {{.subjects = "phone-*", .delay_ms = 60.0}};
  config.osc_out = HostPort{"::1", 9000};
  config.log_level = LogLevel::kWarning;
  EXPECT_EQ(ConfigSummary(config),
            "listen.tcp=0 listen.jitter_buffer=phone-*=60 render.enabled=false osc.out=[::1]:9000 "
            "http.allow_hosts=a, b log.level=warning");
}

TEST(ConfigSummary, IsOneLineWhateverTheValues) {
  Config config;
  config.security.name = "a\nfurrowd ready\x1b[31m";
  EXPECT_EQ(ConfigSummary(config), "security.name=a?furrowd ready?[31m");
}

}  // namespace
}  // namespace furrow::server
