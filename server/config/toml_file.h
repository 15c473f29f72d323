// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/status.h"

// Reads TOML files into variables: tables of keys that know their type and target.
namespace furrow::server::toml_file {

// One key of a table. `assign` stores the value and returns an error, or an empty string.
struct Key {
  std::string_view name;
  std::function<std::string(const toml::node&)> assign;
};

// Each of these makes the key of one type. Nothing is converted: 1.0 is not a port, and 1 is not a
// flag. Targets outlive the key.
Key Text(std::string_view name, std::string* target);
Key Flag(std::string_view name, bool* target);
Key Count(std::string_view name, int* target);
Key Number(std::string_view name, double* target);
Key Texts(std::string_view name, std::vector<std::string>* target);
Key Path(std::string_view name, std::filesystem::path* target, std::filesystem::path folder);
Key Port(std::string_view name, std::uint16_t* target);
Key Port(std::string_view name, std::optional<std::uint16_t>* target);
// A name or a file. Values with a slash or with this ending are files, relative to `folder`.
Key NameOrFile(std::string_view name, std::string_view ending, std::string* target,
               std::filesystem::path folder);
Key NameOrFile(std::string_view name, std::string_view ending, std::filesystem::path* target,
               std::filesystem::path folder);

// The name of a table (empty: the top level of the file) and its keys.
using NamedKeys = std::pair<std::string_view, std::vector<Key>>;
using Tables = std::vector<NamedKeys>;

// Parses the text of a file and reads it into the targets of the keys; the first of `tables` is the
// top level. Unknown names are errors, so that a typing mistake is not silently ignored.
//
// Errors: kParse, kSchema; `where` is "file:line".
[[nodiscard]] Status ReadText(std::string_view text, std::string_view source_name,
                              std::span<const NamedKeys> tables);
// The line at which the text sets a key, "http.port" or "rig"; 0: it does not.
[[nodiscard]] int LineOf(std::string_view text, std::string_view key);
// Reads one table of an array of tables. Returns an error, or an empty string.
[[nodiscard]] std::string ReadTable(const toml::node& node, std::span<const Key> keys);

}  // namespace furrow::server::toml_file
