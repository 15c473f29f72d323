// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"
#include "render/settings/settings.h"

namespace furrow::render {

// Reads a TOML file into `settings`. Settings that the file does not mention keep their value. The
// part of a name before the dot is a TOML table. On failure `settings` is unchanged. Errors:
// kNotFound, kIo, kLimit (above 1 MiB), kParse, kSchema (unknown setting, or a value of the wrong
// type), kInvalidArgument (value out of range). `where` is "file:line"; the message names the
// setting.
[[nodiscard]] Status LoadSettings(const std::filesystem::path& path, Settings* settings);
// Reads TOML text as LoadSettings() reads a file. `source_name` replaces the file name in errors.
[[nodiscard]] Status ParseSettings(std::string_view toml, std::string_view source_name,
                                   Settings* settings);
// Writes all settings as TOML, with help, range and unit as comments. ParseSettings() reads back
// equal settings.
[[nodiscard]] std::string SettingsToToml(const Settings& settings);

}  // namespace furrow::render
