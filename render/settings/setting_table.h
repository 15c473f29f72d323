// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "render/settings/settings.h"

// The list of all settings: name, unit, help, accessor and valid values of each. Everything else in
// this folder is derived from it. Private to render/settings/.
namespace furrow::render {

// In all fields, `of` returns the setting's member of a Settings.
struct NumberField {
  float& (*of)(Settings&);
  float low;  // the valid values: [low, high]
  float high;
  bool above_low = false;  // excludes `low` itself
};

struct CountField {
  int& (*of)(Settings&);
  int low;
  int high;
  std::vector<int> only = {};  // the valid values; empty: all from low to high
};

struct SwitchField {
  bool& (*of)(Settings&);
};

// Linear red, green and blue, each in [0, 1].
struct ColourField {
  glm::vec3& (*of)(Settings&);
};

// An enumeration. Values are positions in `words`.
struct WordField {
  std::span<const std::string_view> words;
  std::function<int(const Settings&)> get;
  std::function<void(Settings&, int)> set;
};

// A list of view names.
struct ViewsField {
  std::vector<View>& (*of)(Settings&);
};

struct SettingEntry {
  std::string_view name;  // "subsurface.method"; at most one dot
  std::string_view unit;  // empty: none
  std::string_view help;
  std::variant<NumberField, CountField, SwitchField, ColourField, WordField, ViewsField> field;
};

// All settings, in the order of the members of Settings.
[[nodiscard]] std::span<const SettingEntry> SettingTable();
[[nodiscard]] const SettingEntry* FindSetting(std::string_view name);  // null: unknown name

}  // namespace furrow::render
