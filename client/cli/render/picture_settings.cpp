// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/picture_settings.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "base/status.h"
#include "render/settings/settings_file.h"

namespace furrow::cli {
namespace {

// Checks values while parsing, so that a typing mistake is an error of usage.
CLI::Validator SettingValidator(std::string prefix) {
  return {[prefix = std::move(prefix)](std::string& value) {
            render::Settings unused;
            const Status status = render::SetSetting(prefix + value, &unused);
            return status.ok() ? std::string() : status.ToString();
          },
          ""};
}

// Adds an option for one setting. Its help, values and default come from the setting's entry.
void AddShorthand(CLI::App& command, const std::string& option, const std::string& setting,
                  PictureOptions* options) {
  const render::SettingInfo& info = InfoOf(setting);
  command
      .add_option_function<std::string>(
          option,
          [options, setting](const std::string& value) {
            options->shorthands.push_back(setting + "=" + value);
          },
          std::string(info.help) + ": " + info.allowed + " (default: " + info.default_value + ")")
      ->check(SettingValidator(setting + "="))
      ->type_name("");
}

// Pictures in files are worth more samples than live pictures, even on slow devices.
render::Settings Defaults() {
  render::Settings settings;
  settings.anti_aliasing.samples = 4;
  return settings;
}

}  // namespace

const render::SettingInfo& InfoOf(const std::string& name) {
  return *std::ranges::find(render::AllSettings(), name, &render::SettingInfo::name);
}

void AddPictureOptions(CLI::App& command, PictureOptions* options) {
  AddShorthand(command, "--view", "view", options);
  AddShorthand(command, "--shading", "shading", options);
  AddShorthand(command, "--lights", "lights.preset", options);
  AddShorthand(command, "--wrinkles", "wrinkles", options);
  AddShorthand(command, "--normal-blend", "normal_blend", options);
  command.add_option(
      "--settings", options->files,
      "TOML files with settings, as --print-settings writes them (repeatable; default: none)");
  command
      .add_option(
          "--set", options->set,
          "Any setting as NAME=VALUE, for example subsurface.method=burley; --print-settings lists "
          "all (repeatable; default: none)")
      ->check(SettingValidator(""));
  command.add_flag_callback(
      "--print-settings",
      [] {
        std::fputs(render::SettingsToToml(Defaults()).c_str(), stdout);
        throw CLI::Success();
      },
      "Print all settings as TOML, with ranges and units, and exit");
}

Result<render::Settings> SettingsOf(const PictureOptions& options) {
  render::Settings settings = Defaults();
  for (const std::string& file : options.files) {
    FURROW_RETURN_IF_ERROR(render::LoadSettings(file, &settings));
  }
  // Later ones win: files, then --set, then the short options.
  for (const auto* assignments : {&options.set, &options.shorthands}) {
    for (const std::string& assignment : *assignments) {
      FURROW_RETURN_IF_ERROR(render::SetSetting(assignment, &settings));
    }
  }
  return settings;
}

}  // namespace furrow::cli
