// SPDX-License-Identifier: Apache-2.0
#include "render/settings/settings_file.h"

#include <optional>
#include <sstream>

#include <toml++/toml.h>

#include "base/files.h"
#include "base/status.h"
#include "render/settings/named_settings.h"
#include "render/settings/setting_table.h"

namespace furrow::render {
namespace {

constexpr std::uint64_t kMaxSettingsBytes = 1 << 20;

// Converts a TOML value to the text that SetSetting() takes. nullopt: the value has the wrong type.
struct NodeText {
  const toml::node& node;

  std::optional<std::string> operator()(const NumberField&) const {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number) return std::nullopt;
    // Nine digits represent every float exactly.
    std::ostringstream text;
    text.precision(9);
    text << *number;
    return text.str();
  }
  std::optional<std::string> operator()(const CountField&) const {
    const auto number = node.value_exact<std::int64_t>();
    return number ? std::optional(std::to_string(*number)) : std::nullopt;
  }
  std::optional<std::string> operator()(const SwitchField&) const {
    const auto on = node.value_exact<bool>();
    return on ? std::optional<std::string>(*on ? "on" : "off") : std::nullopt;
  }
  std::optional<std::string> operator()(const WordField&) const {
    return node.value_exact<std::string>();
  }
  std::optional<std::string> operator()(const ColourField&) const {
    return Elements(NumberField{});
  }
  std::optional<std::string> operator()(const ViewsField&) const { return Elements(WordField{}); }

  template <class Element>
  std::optional<std::string> Elements(const Element& element) const {
    const toml::array* array = node.as_array();
    if (array == nullptr) return std::nullopt;
    std::string joined;
    for (const toml::node& child : *array) {
      const auto text = NodeText{child}(element);
      if (!text) return std::nullopt;
      joined += (joined.empty() ? "" : ",") + *text;
    }
    return joined;
  }
};

// The TOML type of a setting, for messages.
std::string_view TypeName(const SettingEntry& entry) {
  struct Name {
    std::string_view operator()(const NumberField&) const { return "a number"; }
    std::string_view operator()(const CountField&) const { return "a whole number"; }
    std::string_view operator()(const SwitchField&) const { return "true or false"; }
    std::string_view operator()(const WordField&) const { return "a string"; }
    std::string_view operator()(const ColourField&) const { return "an array of three numbers"; }
    std::string_view operator()(const ViewsField&) const { return "an array of strings"; }
  };
  return std::visit(Name{}, entry.field);
}

// Reads a table and its sub-tables into Settings.
class TomlReader {
 public:
  TomlReader(std::string_view source_name, Settings* settings)
      : source_name_(source_name), settings_(settings) {}

  // Tables that are not settings are groups: their keys continue the dotted name.
  Status Read(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string name = prefix + std::string(key.str());
      const toml::table* inner = node.as_table();
      if (inner != nullptr && FindSetting(name) == nullptr) {
        FURROW_RETURN_IF_ERROR(Read(*inner, name + "."));
      } else {
        FURROW_RETURN_IF_ERROR(ReadValue(name, node));
      }
    }
    return {};
  }

 private:
  Status ReadValue(const std::string& name, const toml::node& node) {
    const SettingEntry* entry = FindSetting(name);
    if (entry == nullptr) {
      const Status unknown = SetSetting(name, "", settings_);  // lists similar settings
      return {StatusCode::kSchema, "no setting '" + name + "'", Place(node), unknown.todo()};
    }
    const std::optional<std::string> text = std::visit(NodeText{node}, entry->field);
    if (!text) {
      return {StatusCode::kSchema, name + " must be " + std::string(TypeName(*entry)), Place(node)};
    }
    const Status status = SetSetting(name, *text, settings_);
    if (status.ok()) return status;
    return {status.code(), name + ": " + status.what(), Place(node), status.todo()};
  }

  std::string Place(const toml::node& node) const {
    return std::string(source_name_) + ":" + std::to_string(node.source().begin.line);
  }

  std::string_view source_name_;
  Settings* settings_;
};

// Converts the text of GetSetting() to a TOML value.
struct TomlText {
  std::string text;  // GetSetting()

  std::string operator()(const NumberField&) const { return text; }
  std::string operator()(const CountField&) const { return text; }
  std::string operator()(const SwitchField&) const { return text == "on" ? "true" : "false"; }
  std::string operator()(const WordField&) const { return '"' + text + '"'; }
  std::string operator()(const ColourField&) const { return '[' + text + ']'; }
  std::string operator()(const ViewsField&) const {
    std::string quoted;
    for (const char c : text) quoted += c == ',' ? std::string("\", \"") : std::string(1, c);
    return text.empty() ? "[]" : "[\"" + quoted + "\"]";
  }
};

}  // namespace

Status ParseSettings(std::string_view text, std::string_view source_name, Settings* settings) {
  // Works on a copy, so that an invalid file changes nothing.
  Settings changed = *settings;
  try {
    const toml::table table = toml::parse(text, source_name);
    FURROW_RETURN_IF_ERROR(TomlReader(source_name, &changed).Read(table, ""));
  } catch (const toml::parse_error& error) {
    return {StatusCode::kParse, std::string(error.description()),
            std::string(source_name) + ":" + std::to_string(error.source().begin.line)};
  }
  *settings = changed;
  return {};
}

Status LoadSettings(const std::filesystem::path& path, Settings* settings) {
  const Result<std::string> text = ReadFile(path, kMaxSettingsBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseSettings(*text, path.string(), settings);
}

std::string SettingsToToml(const Settings& settings) {
  std::string toml;
  std::string_view table;
  const auto table_of = [](std::string_view name) {
    const std::size_t dot = name.find('.');
    return dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
  };
  for (const SettingInfo& info : AllSettings()) {
    if (table_of(info.name) != table) {
      table = table_of(info.name);
      toml += "\n[" + std::string(table) + "]\n";
    }
    toml += "# " + std::string(info.help) + ": " + info.allowed +
            (info.unit.empty() ? "" : " " + std::string(info.unit)) + "\n";
    const std::string_view key = info.name.substr(table.empty() ? 0 : table.size() + 1);
    const SettingEntry* entry = FindSetting(info.name);
    toml += std::string(key) + " = " +
            std::visit(TomlText{GetSetting(info.name, settings)}, entry->field) + "\n";
  }
  return toml;
}

}  // namespace furrow::render
