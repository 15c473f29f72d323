// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "render/settings/named_settings.h"

namespace furrow::cli {

// What a command line says of the appearance: later ones win, in the order file, names, switches.
struct PictureOptions {
  std::vector<std::string> files;       // --settings FILE.toml
  std::vector<std::string> set;         // --set NAME=VALUE
  std::vector<std::string> shorthands;  // NAME=VALUE of --view, --shading, --lights, ...
};

// What render::AllSettings() says of one. Precondition: it has the name.
[[nodiscard]] const render::SettingInfo& InfoOf(const std::string& name);

// Adds --settings, --set, --print-settings (prints the defaults and ends) and short names for the
// settings most used.
void AddPictureOptions(CLI::App& command, PictureOptions* options);

// The settings that the options ask for. Errors: of render::LoadSettings() and SetSetting().
[[nodiscard]] Result<render::Settings> SettingsOf(const PictureOptions& options);

}  // namespace furrow::cli
