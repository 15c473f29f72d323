// SPDX-License-Identifier: Apache-2.0
#include "server/config/toml_file.h"

#include <algorithm>
#include <cstddef>

#include "base/text.h"

namespace furrow::server::toml_file {
namespace {

Key PathOrName(std::string_view name, std::string_view ending, std::filesystem::path folder,
               std::function<void(std::string)> set) {
  return {name, [=, folder = std::move(folder)](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            const bool file = value->find('/') != std::string::npos || value->ends_with(ending);
            set(file ? (folder / *value).string() : *value);
            return {};
          }};
}

template <class Target>
Key AnyPort(std::string_view name, Target* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::int64_t>();
            if (!value || *value < 0 || *value > 65535) return "must be a port number, 0 to 65535";
            *target = static_cast<std::uint16_t>(*value);
            return {};
          }};
}

class Reader {
 public:
  // Reads a parsed file into the targets of the keys. Unknown names are errors, so that a typing
  // mistake is not silently ignored.
  Reader(std::string_view source_name) : source_name_(source_name) {}

  // Reads the top level, which is the first of `tables`, and then the other tables.
  Status ReadFile(const toml::table& root, std::span<const NamedKeys> tables) const {
    Status status = ReadTable(root, "", tables.front().second, tables.subspan(1));
    for (const auto& [name, keys] : tables.subspan(1)) {
      const toml::table* table = root[name].as_table();
      if (status.ok() && table != nullptr) {
        status = ReadTable(*table, std::string(name) + ".", keys, {});
      }
    }
    return status;
  }

 private:
  // `subtables`: names at this level that are tables, not keys.
  Status ReadTable(const toml::table& table, std::string_view prefix, std::span<const Key> keys,
                   std::span<const NamedKeys> subtables) const {
    for (const auto& [key, node] : table) {
      const std::string name = std::string(prefix) + std::string(key.str());
      const auto known = std::ranges::find(keys, key.str(), &Key::name);
      const auto subtable = std::ranges::find(subtables, key.str(), &NamedKeys::first);
      if (known != keys.end()) {
        if (std::string fault = known->assign(node); !fault.empty()) {
          return Error(StatusCode::kSchema, node, name + " " + fault);
        }
      } else if (subtable == subtables.end()) {
        return Error(StatusCode::kSchema, node,
                     "unknown key '" + name + "'" + Meant(key.str(), prefix, keys, subtables));
      } else if (!node.is_table()) {
        return Error(StatusCode::kSchema, node, name + " must be a table");
      }
    }
    return {};
  }

  // "; did you mean 'listen.tcp'?", or nothing.
  static std::string Meant(std::string_view key, std::string_view prefix, std::span<const Key> keys,
                           std::span<const NamedKeys> subtables) {
    std::vector<std::string> known;
    for (const Key& each : keys) known.emplace_back(each.name);
    for (const NamedKeys& table : subtables) known.emplace_back(table.first);
    const std::string meant = DidYouMean(key, known, prefix);
    return meant.empty() ? "" : "; " + meant;
  }

  // `where` is file and line, as compilers write it.
  Status Error(StatusCode code, const toml::node& node, std::string what) const {
    return Status(code, std::move(what),
                  std::string(source_name_) + ":" + std::to_string(node.source().begin.line));
  }

  std::string_view source_name_;
};

}  // namespace

Key Text(std::string_view name, std::string* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            *target = *value;
            return {};
          }};
}

Key Path(std::string_view name, std::filesystem::path* target, std::filesystem::path folder) {
  return {name, [target, folder = std::move(folder)](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::string>();
            if (!value) return "must be a string";
            // An absolute path stays as it is, and an empty one is none.
            *target = value->empty() ? std::filesystem::path() : folder / *value;
            return {};
          }};
}

Key Flag(std::string_view name, bool* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<bool>();
            if (!value) return "must be true or false";
            *target = *value;
            return {};
          }};
}

Key Count(std::string_view name, int* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const auto value = node.value_exact<std::int64_t>();
            if (!value || !std::in_range<int>(*value)) return "must be a whole number";
            *target = static_cast<int>(*value);
            return {};
          }};
}

Key Number(std::string_view name, double* target) {
  return {name, [target](const toml::node& node) -> std::string {
            // Whole numbers are valid numbers, so value() converts them; is_number() rules out
            // other types.
            const auto value = node.value<double>();
            if (!node.is_number() || !value) return "must be a number";
            *target = *value;
            return {};
          }};
}

Key Texts(std::string_view name, std::vector<std::string>* target) {
  return {name, [target](const toml::node& node) -> std::string {
            const toml::array* list = node.as_array();
            if (list == nullptr) return "must be a list of strings";
            std::vector<std::string> texts;
            for (const toml::node& element : *list) {
              const auto value = element.value_exact<std::string>();
              if (!value) return "must be a list of strings";
              texts.push_back(*value);
            }
            *target = std::move(texts);
            return {};
          }};
}

Key Port(std::string_view name, std::uint16_t* target) { return AnyPort(name, target); }
Key Port(std::string_view name, std::optional<std::uint16_t>* target) {
  return AnyPort(name, target);
}

Key NameOrFile(std::string_view name, std::string_view ending, std::string* target,
               std::filesystem::path folder) {
  return PathOrName(name, ending, std::move(folder),
                    [target](std::string value) { *target = std::move(value); });
}
Key NameOrFile(std::string_view name, std::string_view ending, std::filesystem::path* target,
               std::filesystem::path folder) {
  return PathOrName(name, ending, std::move(folder),
                    [target](std::string value) { *target = std::move(value); });
}

Status ReadText(std::string_view text, std::string_view source_name,
                std::span<const NamedKeys> tables) {
  toml::table root;
  try {
    root = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    // The parser of toml++ throws; the rest of the daemon uses Status.
    return Status(StatusCode::kParse, std::string(error.description()),
                  std::string(source_name) + ":" + std::to_string(error.source().begin.line));
  }
  return Reader(source_name).ReadFile(root, tables);
}

int LineOf(std::string_view text, std::string_view key) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error&) {
    return 0;
  }
  const std::size_t dot = key.find('.');
  const bool is_top_level = dot == std::string_view::npos;
  const toml::table* table = is_top_level ? &root : root[key.substr(0, dot)].as_table();
  if (table == nullptr) return 0;
  const toml::node* node = table->get(is_top_level ? key : key.substr(dot + 1));
  return node == nullptr ? 0 : static_cast<int>(node->source().begin.line);
}

std::string ReadTable(const toml::node& node, std::span<const Key> keys) {
  const toml::table* table = node.as_table();
  if (table == nullptr) return "must be a table";
  for (const auto& [key, value] : *table) {
    const auto known = std::ranges::find(keys, key.str(), &Key::name);
    if (known == keys.end()) return "has the unknown key '" + std::string(key.str()) + "'";
    if (std::string fault = known->assign(value); !fault.empty()) {
      return std::string(key.str()) + " " + fault;
    }
  }
  return {};
}

}  // namespace furrow::server::toml_file
