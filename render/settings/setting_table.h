// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "render/settings/settings.h"

// How each setting is reached, and what it may be: the one list that names, files, checks and help
// are made from. Private to render/settings*.cpp.
namespace furrow::render {

struct NumberField {
  float& (*of)(Settings&);
  float low;
  float high;
  bool above_low = false;  // `low` itself is not allowed
};

struct CountField {
  int& (*of)(Settings&);
  int low;
  int high;
  std::vector<int> only = {};  // empty: all from low to high
};

struct SwitchField {
  bool& (*of)(Settings&);
};

struct ColourField {
  glm::vec3& (*of)(Settings&);
};

struct WordField {
  std::span<const std::string_view> words;
  std::function<int(const Settings&)> get;
  std::function<void(Settings&, int)> set;
};

struct ViewsField {
  std::vector<View>& (*of)(Settings&);
};

struct SettingEntry {
  std::string_view name;
  std::string_view unit;
  std::string_view help;
  std::variant<NumberField, CountField, SwitchField, ColourField, WordField, ViewsField> field;
};

[[nodiscard]] std::span<const std::string_view> ViewNames();
[[nodiscard]] std::span<const SettingEntry> SettingTable();
[[nodiscard]] const SettingEntry* FindSetting(std::string_view name);  // null: no such

}  // namespace furrow::render
