// SPDX-License-Identifier: Apache-2.0
#include "server/config/osc_profile_file.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/data_dir.h"
#include "base/files.h"
#include "base/joined.h"
#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "server/config/toml_file.h"

namespace furrow::server {
namespace {

using protocol::mocap::OscField;
using protocol::mocap::OscProfile;
using protocol::mocap::OscTemplate;

constexpr std::uint64_t kMaxProfileBytes = 1 << 20;
constexpr std::size_t kMaxArguments = 6;

// The words of `arguments`, as in docs/engines/osc.md.
constexpr std::pair<std::string_view, OscField> kFields[] = {
    {"name", OscField::kName},
    {"subject", OscField::kSubject},
    {"value", OscField::kValue},
    {"sequence", OscField::kSequence},
    {"capture_time", OscField::kCaptureTime},
    {"timecode", OscField::kTimecode}};
constexpr std::string_view kPlaceholders[] = {"{prefix}", "{subject}", "{name}", "{identifier}"};

// Returns the fault of an address; empty: none. Values fill the placeholders and are made safe
// later; everything around them must be a valid OSC address by itself.
std::string AddressFault(std::string_view address) {
  if (!address.starts_with('/') || address.size() > protocol::kMaxNameBytes) {
    return "must begin with '/' and have at most 255 bytes";
  }
  while (!address.empty()) {
    const auto placeholder = std::ranges::find_if(
        kPlaceholders, [address](std::string_view word) { return address.starts_with(word); });
    if (placeholder != std::end(kPlaceholders)) {
      address.remove_prefix(placeholder->size());
      continue;
    }
    const char c = address.front();
    if (std::string_view(" #*,?[]{}").find(c) != std::string_view::npos || c < '!' || c > '~') {
      return "must not contain blanks or any of #*,?[] and no braces but {prefix}, {subject}, "
             "{name} and {identifier}";
    }
    address.remove_prefix(1);
  }
  return {};
}

toml_file::Key Address(std::string* target) {
  return {"address", [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            *target = *value;
            return AddressFault(*value);
          }};
}

toml_file::Key Arguments(std::vector<OscField>* target) {
  return {"arguments", [target](const toml::node& node) -> std::string {
            const toml::array* list = node.as_array();
            if (list == nullptr || list->size() > kMaxArguments) {
              return "must be a list of at most " + std::to_string(kMaxArguments) + " words";
            }
            for (const toml::node& element : *list) {
              const auto word = element.value_exact<std::string>();
              const auto field = std::ranges::find_if(
                  kFields, [&word](const auto& known) { return word && known.first == *word; });
              if (field == std::end(kFields)) {
                return "may list name, subject, value, sequence, capture_time and timecode";
              }
              target->push_back(field->second);
            }
            return {};
          }};
}

// [names] has keys of its own, so it is read as one value.
toml_file::Key Names(std::map<std::string, std::string>* target) {
  return {"names", [target](const toml::node& node) -> std::string {
            const toml::table* table = node.as_table();
            if (table == nullptr) return "must be a table";
            for (const auto& [name, value] : *table) {
              const auto text = value.value_exact<std::string>();
              if (!text || text->empty() || text->size() > protocol::kMaxNameBytes ||
                  !protocol::IsPlainText(*text)) {
                return "'" + std::string(name.str()) +
                       "' must be a text of 1 to 255 bytes without control characters";
              }
              target->emplace(std::string(name.str()), *text);
            }
            return {};
          }};
}

// Sets a message that a profile may leave out.
Status SetOptional(OscTemplate read, std::string_view table, std::string_view source_name,
                   std::optional<OscTemplate>* target) {
  if (!read.address.empty()) {
    *target = std::move(read);
  } else if (!read.arguments.empty()) {
    return Status(StatusCode::kSchema, std::string(table) + ".address is missing",
                  std::string(source_name));
  }
  return {};
}

bool IsFile(const std::string& name) {
  return name.find('/') != std::string::npos || name.ends_with(".toml");
}

}  // namespace

Result<OscProfile> ParseOscProfile(std::string_view text, std::string_view source_name) {
  OscProfile profile;
  profile.name = std::filesystem::path(source_name).stem().string();
  OscTemplate timecode;
  OscTemplate end;
  std::string description;
  const toml_file::NamedKeys tables[] = {
      {"",
       {toml_file::Text("description", &description),
        toml_file::Flag("only_renamed", &profile.only_renamed), Names(&profile.names)}},
      {"value", {Address(&profile.value.address), Arguments(&profile.value.arguments)}},
      {"timecode", {Address(&timecode.address), Arguments(&timecode.arguments)}},
      {"end", {Address(&end.address), Arguments(&end.arguments)}}};
  FURROW_RETURN_IF_ERROR(toml_file::ReadText(text, source_name, tables));
  if (profile.value.address.empty()) {
    return Status(StatusCode::kSchema, "value.address is missing", std::string(source_name));
  }
  FURROW_RETURN_IF_ERROR(
      SetOptional(std::move(timecode), "timecode", source_name, &profile.timecode));
  FURROW_RETURN_IF_ERROR(SetOptional(std::move(end), "end", source_name, &profile.end));
  return profile;
}

bool IsShippedOscProfile(const std::string& name) {
  return std::ranges::binary_search(ShippedOscProfiles(), name);
}

std::vector<std::string> ShippedOscProfiles() {
  std::vector<std::string> names;
  const auto shipped = FindDataFile("osc");
  if (!shipped.ok()) return names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(*shipped, error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

Result<OscProfile> LoadOscProfile(const std::string& name) {
  std::filesystem::path path = name;
  if (!IsFile(name)) {
    auto shipped = FindDataFile("osc/" + name + ".toml");
    if (!shipped.ok()) {
      return Status(StatusCode::kNotFound, "there is no OSC profile '" + name + "'", "profile",
                    "shipped profiles: " + Joined(ShippedOscProfiles()) +
                        "; a file needs a '/' or the ending .toml");
    }
    path = *std::move(shipped);
  }
  const Result<std::string> text = ReadFile(path, kMaxProfileBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseOscProfile(*text, path.string());
}

}  // namespace furrow::server
