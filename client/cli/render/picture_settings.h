// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "render/settings/named_settings.h"

namespace furrow::cli {

// The options that set the appearance of pictures, in order of increasing priority.
struct PictureOptions {
  std::vector<std::string> files;       // --settings FILE.toml
  std::vector<std::string> set;         // --set NAME=VALUE
  std::vector<std::string> shorthands;  // NAME=VALUE of --view, --shading, --lights, ...
};

// The entry of a setting in render::AllSettings(). Precondition: the setting exists.
[[nodiscard]] const render::SettingInfo& InfoOf(const std::string& name);

// Adds --settings, --set, --print-settings and options for the most used settings. `options` must
// outlive parsing.
void AddPictureOptions(CLI::App& command, PictureOptions* options);

// The defaults, overridden by `options`. Errors: those of render::LoadSettings() and SetSetting().
[[nodiscard]] Result<render::Settings> SettingsOf(const PictureOptions& options);

}  // namespace furrow::cli
