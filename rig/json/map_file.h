// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "base/text.h"

// What the readers of skeleton maps, shape maps and export profiles share. These files are JSON
// with comments, and may be hostile.
namespace furrow::rig {

inline constexpr std::size_t kMaxMapBytes = 1 << 20;

// `text` with `side` in place of every '*', which stands for a side in names. Continues behind each
// replacement, so a side that contains '*' cannot loop.
[[nodiscard]] std::string WithSide(std::string text, const std::string& side);

// Parses the text of a file; Json: nlohmann's json, or ordered_json. Errors, with the file as
// `where`: kLimit (larger than kMaxMapBytes), kParse.
template <class Json>
[[nodiscard]] Status ParseMapText(std::string_view text, std::string_view source, Json* root) {
  if (text.size() > kMaxMapBytes) {
    return Status(StatusCode::kLimit, "larger than 1 MiB", std::string(source));
  }
  // The parser throws on malformed text, and nothing here lets an exception out.
  try {
    *root = Json::parse(text.begin(), text.end(), nullptr, true, /*ignore_comments=*/true);
  } catch (const typename Json::exception& error) {
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
