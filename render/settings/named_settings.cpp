// SPDX-License-Identifier: Apache-2.0
#include "render/settings/named_settings.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "render/settings/setting_table.h"

namespace furrow::render {
namespace {

constexpr std::size_t kMaxStripViews = 6;

// The shortest text that reads back as the same float, whatever the locale.
std::string NumberText(float value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr};
}

std::string Join(std::span<const std::string_view> words, std::string_view between) {
  std::string joined;
  for (const std::string_view word : words) {
    joined += (joined.empty() ? "" : std::string(between)) + std::string(word);
  }
  return joined;
}

// Reads the whole text as a number. Trailing characters make it invalid.
template <class Number>
bool ReadNumber(std::string_view text, Number* number) {
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, *number);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

std::vector<std::string_view> Split(std::string_view text) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    std::string_view part = text.substr(0, comma);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    parts.push_back(part);
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return parts;
}

// NaN fails every comparison, so each test asks for valid values and rejects NaN too.
bool IsValid(const NumberField& field, float value) {
  return (field.above_low ? value > field.low : value >= field.low) && value <= field.high;
}
bool IsValid(const CountField& field, int value) {
  if (!field.only.empty()) return std::ranges::find(field.only, value) != field.only.end();
  return value >= field.low && value <= field.high;
}
bool IsValid(const glm::vec3& colour) {
  return std::ranges::all_of(std::array{colour.r, colour.g, colour.b},
                             [](float value) { return value >= 0.0f && value <= 1.0f; });
}

// Lists the valid values of a field, for messages and help.
struct ValidValues {
  std::string operator()(const NumberField& field) const {
    return (field.above_low ? "(" : "[") + NumberText(field.low) + ", " + NumberText(field.high) +
           "]";
  }
  std::string operator()(const CountField& field) const {
    if (field.only.empty()) {
      return "whole numbers in [" + std::to_string(field.low) + ", " + std::to_string(field.high) +
             "]";
    }
    std::string text;
    for (const int value : field.only) text += (text.empty() ? "" : ", ") + std::to_string(value);
    return text;
  }
  std::string operator()(const SwitchField&) const { return "on, off"; }
  std::string operator()(const ColourField&) const { return "three numbers in [0, 1]"; }
  std::string operator()(const WordField& field) const { return Join(field.words, ", "); }
  std::string operator()(const ViewsField&) const {
    return "up to " + std::to_string(kMaxStripViews) + " of " + Join(ViewNames(), ", ");
  }
};

// Fills in the range and choices that a page needs for its controls.
struct Describer {
  SettingInfo& info;
  void operator()(const NumberField& field) const { SetRange(field.low, field.high); }
  void operator()(const CountField& field) const {
    info.kind = SettingInfo::Kind::kCount;
    SetRange(static_cast<float>(field.low), static_cast<float>(field.high));
    for (const int value : field.only) info.choices.push_back(std::to_string(value));
  }
  void operator()(const SwitchField&) const { info.kind = SettingInfo::Kind::kSwitch; }
  void operator()(const ColourField&) const {
    info.kind = SettingInfo::Kind::kColour;
    SetRange(0.0f, 1.0f);
  }
  void operator()(const WordField& field) const {
    info.kind = SettingInfo::Kind::kWord;
    info.choices.assign(field.words.begin(), field.words.end());
  }
  void operator()(const ViewsField&) const {
    info.kind = SettingInfo::Kind::kViews;
    info.choices.assign(ViewNames().begin(), ViewNames().end());
  }
  void SetRange(float low, float high) const {
    info.low = low;
    info.high = high;
  }
};

// Formats the value of a field as SetSetting() takes it.
struct Getter {
  Settings& settings;
  std::string operator()(const NumberField& field) const { return NumberText(field.of(settings)); }
  std::string operator()(const CountField& field) const {
    return std::to_string(field.of(settings));
  }
  std::string operator()(const SwitchField& field) const {
    return field.of(settings) ? "on" : "off";
  }
  std::string operator()(const ColourField& field) const {
    const glm::vec3& colour = field.of(settings);
    return NumberText(colour.r) + "," + NumberText(colour.g) + "," + NumberText(colour.b);
  }
  std::string operator()(const WordField& field) const {
    const auto value = static_cast<std::size_t>(field.get(settings));
    return value < field.words.size() ? std::string(field.words[value]) : std::to_string(value);
  }
  std::string operator()(const ViewsField& field) const {
    std::vector<std::string_view> names;
    for (const View view : field.of(settings)) names.push_back(ViewName(view));
    return Join(names, ",");
  }
};

// Parses `text` into a field. Returns false, and changes nothing, if the text is invalid.
struct Setter {
  Settings& settings;
  std::string_view text;
  bool operator()(const NumberField& field) const {
    float value = 0.0f;
    if (!ReadNumber(text, &value) || !IsValid(field, value)) return false;
    field.of(settings) = value;
    return true;
  }
  bool operator()(const CountField& field) const {
    int value = 0;
    if (!ReadNumber(text, &value) || !IsValid(field, value)) return false;
    field.of(settings) = value;
    return true;
  }
  bool operator()(const SwitchField& field) const {
    const bool on = text == "on" || text == "true";
    if (!on && text != "off" && text != "false") return false;
    field.of(settings) = on;
    return true;
  }
  bool operator()(const ColourField& field) const {
    const std::vector<std::string_view> parts = Split(text);
    glm::vec3 colour(0.0f);
    if (parts.size() != 3) return false;
    for (int i = 0; i < 3; ++i) {
      if (!ReadNumber(parts[static_cast<std::size_t>(i)], &colour[i])) return false;
    }
    if (!IsValid(colour)) return false;
    field.of(settings) = colour;
    return true;
  }
  bool operator()(const WordField& field) const {
    const auto found = std::ranges::find(field.words, text);
    if (found == field.words.end()) return false;
    field.set(settings, static_cast<int>(found - field.words.begin()));
    return true;
  }
  bool operator()(const ViewsField& field) const {
    std::vector<View> views;
    for (const std::string_view name : Split(text)) {
      const Result<View> view = ParseView(name);
      if (!view.ok()) return false;
      views.push_back(*view);
    }
    if (views.size() > kMaxStripViews) return false;
    field.of(settings) = std::move(views);
    return true;
  }
};

// Returns true if the value of a field is valid.
struct Checker {
  Settings& settings;
  bool operator()(const NumberField& field) const { return IsValid(field, field.of(settings)); }
  bool operator()(const CountField& field) const { return IsValid(field, field.of(settings)); }
  bool operator()(const SwitchField&) const { return true; }
  bool operator()(const ColourField& field) const { return IsValid(field.of(settings)); }
  bool operator()(const WordField& field) const {
    const int value = field.get(settings);
    return value >= 0 && value < static_cast<int>(field.words.size());
  }
  bool operator()(const ViewsField& field) const {
    return field.of(settings).size() <= kMaxStripViews;
  }
};

// A hint for an unknown name: the settings of the same table, and those with the same last part. If
// there are none, the top-level settings and the tables.
std::string SimilarSettings(std::string_view name) {
  const std::string_view table = name.substr(0, std::min(name.find('.'), name.size()));
  const std::string_view last = name.substr(name.rfind('.') + 1);
  std::string near;
  for (const SettingEntry& entry : SettingTable()) {
    const bool same_table = entry.name.starts_with(std::string(table) + ".");
    if (same_table || entry.name == last || entry.name.ends_with("." + std::string(last))) {
      near += (near.empty() ? "" : ", ") + std::string(entry.name);
    }
  }
  if (!near.empty()) return "similar settings: " + near;
  std::string_view listed;
  for (const SettingEntry& entry : SettingTable()) {
    const std::size_t dot = entry.name.find('.');
    const std::string_view one = entry.name.substr(0, dot);
    if (one == listed) continue;
    near += (near.empty() ? "" : ", ") + std::string(one) + (dot < entry.name.size() ? ".*" : "");
    listed = one;
  }
  return "settings: " + near + "; 'furrow render --print-settings' lists them all";
}

}  // namespace

const std::vector<SettingInfo>& AllSettings() {
  static const std::vector<SettingInfo> all = [] {
    std::vector<SettingInfo> infos;
    const Settings defaults;
    for (const SettingEntry& entry : SettingTable()) {
      infos.push_back({entry.name, entry.unit, entry.help, std::visit(ValidValues{}, entry.field),
                       GetSetting(entry.name, defaults)});
      std::visit(Describer{infos.back()}, entry.field);
    }
    return infos;
  }();
  return all;
}

Status SetSetting(std::string_view name, std::string_view value, Settings* settings) {
  const SettingEntry* entry = FindSetting(name);
  if (entry == nullptr) {
    return {StatusCode::kNotFound, "no such setting", std::string(name), SimilarSettings(name)};
  }
  if (std::visit(Setter{*settings, value}, entry->field)) return {};
  return {StatusCode::kInvalidArgument, "'" + std::string(value) + "' is invalid",
          std::string(name), "valid: " + std::visit(ValidValues{}, entry->field)};
}

Status SetSetting(std::string_view assignment, Settings* settings) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return {StatusCode::kInvalidArgument, "expected NAME=VALUE", std::string(assignment)};
  }
  return SetSetting(assignment.substr(0, equals), assignment.substr(equals + 1), settings);
}

// The accessors of the table take a mutable Settings. Getter and Checker only read through them.
std::string GetSetting(std::string_view name, const Settings& settings) {
  return std::visit(Getter{const_cast<Settings&>(settings)}, FindSetting(name)->field);
}

Status CheckSettings(const Settings& settings) {
  for (const SettingEntry& entry : SettingTable()) {
    if (std::visit(Checker{const_cast<Settings&>(settings)}, entry.field)) continue;
    return {
        StatusCode::kInvalidArgument,
        GetSetting(entry.name, settings) + " is outside " + std::visit(ValidValues{}, entry.field),
        "settings." + std::string(entry.name)};
  }
  return {};
}

}  // namespace furrow::render
