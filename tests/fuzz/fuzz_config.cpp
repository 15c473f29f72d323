// SPDX-License-Identifier: Apache-2.0
// The daemon's configuration and profiles of OSC. After an error, the configuration is as before,
// and the error names the file.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "server/config/config.h"
#include "server/config/osc_profile_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::server;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Config config;
  config.bind = "untouched";
  const furrow::Status status = ParseConfig(text, "fuzz.toml", &config);
  if (!status.ok()) {
    if (!status.where().starts_with("fuzz.toml")) std::abort();
    if (config.bind != "untouched" || config.tcp != Config().tcp) std::abort();
  }
  const auto profile = ParseOscProfile(text, "fuzz.toml");
  if (!profile.ok() && !profile.status().where().starts_with("fuzz.toml")) std::abort();
  return 0;
}
