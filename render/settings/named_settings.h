// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "render/settings/settings.h"

// Settings by name, for settings files, command lines, HTTP and the preview page's menu.
namespace furrow::render {

// Describes one setting.
struct SettingInfo {
  enum class Kind { kNumber, kCount, kSwitch, kColour, kWord, kViews };
  std::string_view name;  // "subsurface.method"
  std::string_view unit;  // "mm"; empty: none
  std::string_view help;
  std::string allowed;        // valid values, for people: "off, pcf, pcss" or "[0, 8]"
  std::string default_value;  // as text that SetSetting() accepts
  Kind kind = Kind::kNumber;
  float low = 0.0f;  // range of numbers, counts and colours
  float high = 0.0f;
  std::vector<std::string> choices;  // words, views, and counts that allow single values only
};
// All settings, in the order of the members of Settings.
[[nodiscard]] const std::vector<SettingInfo>& AllSettings();

// Sets one setting from text: a number, on/off/true/false, a word, "r,g,b", or view names joined by
// commas. On failure `settings` is unchanged. Errors: kNotFound (unknown name; the error lists
// similar ones), kInvalidArgument (invalid value; the error lists the valid ones). `where` is the
// name.
[[nodiscard]] Status SetSetting(std::string_view name, std::string_view value, Settings* settings);
// Sets one setting from "name=value".
[[nodiscard]] Status SetSetting(std::string_view assignment, Settings* settings);
// The value of a setting as text that SetSetting() accepts. Precondition: AllSettings() lists
// `name`.
[[nodiscard]] std::string GetSetting(std::string_view name, const Settings& settings);

// Checks every setting against its range. Error: kInvalidArgument for the first invalid one;
// `where` is "settings.<name>".
[[nodiscard]] Status CheckSettings(const Settings& settings);

}  // namespace furrow::render
