// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/json_index.h"
#include "base/status.h"
#include "base/text.h"

// What the readers of skeleton maps, shape maps and export profiles share. These files are JSON
// with comments, and may be hostile.
namespace furrow::rig {

inline constexpr std::size_t kMaxMapBytes = 1 << 20;
// Twice what the largest export profile has. ordered_json compares each new field with all others
// of its object, so a file of 1 MiB with short fields would take a minute.
inline constexpr std::size_t kMaxMapFields = 8192;

// `text` with `side` in place of every '*', which stands for a side in names. Continues behind each
// replacement, so a side that contains '*' cannot loop.
[[nodiscard]] std::string WithSide(std::string text, const std::string& side);

// Parses the text of a file; Json: nlohmann's json, or ordered_json. Errors, with the file as
// `where`: kLimit (above kMaxMapBytes, or more than kMaxMapFields in all objects together), kParse.
template <class Json>
[[nodiscard]] Status ParseMapText(std::string_view text, std::string_view source, Json* root) {
  if (text.size() > kMaxMapBytes) {
    return Status(StatusCode::kLimit, "larger than 1 MiB", std::string(source));
  }
  struct TooManyFields {};
  std::size_t num_fields = 0;
  const auto count = [&](int, typename Json::parse_event_t event, Json&) {
    if (event == Json::parse_event_t::key && ++num_fields > kMaxMapFields) throw TooManyFields();
    return true;
  };
  // The parser throws on malformed text, and nothing here lets an exception out.
  try {
    *root = Json::parse(text.begin(), text.end(), count, true, /*ignore_comments=*/true);
  } catch (const TooManyFields&) {
    return Status(StatusCode::kLimit, "has more than " + std::to_string(kMaxMapFields) + " fields",
                  std::string(source));
  } catch (const typename Json::exception& error) {
    // The index explains the fault in plain words, and where it is.
    const auto index = JsonIndex::Create(text);
    if (!index.ok()) {
      return Status(StatusCode::kParse, index.status().what(),
                    std::string(source) + ":" + index.status().where(), index.status().todo());
    }
    return Status(StatusCode::kParse, std::string("malformed JSON: ") + error.what(),
                  std::string(source));
  }
  return {};
}

// Errors of one file, which name the file and the field.
class MapErrors {
 public:
  explicit MapErrors(std::string_view source) : source_(source) {}

  [[nodiscard]] Status Error(const std::string& field, std::string what,
                             StatusCode code = StatusCode::kSchema) const {
    return {code, std::move(what), source_ + ": " + field};
  }

  // Checks that a file is an object of version 1 with the field "name" and the field `content`, and
  // with no other fields than these and `optional`. Unknown fields are errors: a misspelled field
  // would otherwise have no effect. Errors: kSchema, kUnsupported (another version).
  template <class Json>
  [[nodiscard]] Status CheckRoot(const Json& root, const char* content,
                                 const std::set<std::string>& optional) const {
    if (!root.is_object()) return Error("(root)", "expected an object");
    const std::set<std::string> required = {"version", "name", content};
    for (const auto& [key, value] : root.items()) {
      if (!required.contains(key) && !optional.contains(key)) {
        return Error(Quoted(key), "unknown field");
      }
    }
    for (const char* key : {"version", "name", content}) {
      if (!root.contains(key)) return Error(key, "is missing");
    }
    if (root["version"] != 1) return Error("version", "expected 1", StatusCode::kUnsupported);
    return {};
  }

 private:
  std::string source_;
};

}  // namespace furrow::rig
