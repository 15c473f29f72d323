// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace furrow::server {

// A decoded request target.
struct Url {
  std::string path;                                         // "/api/explain"
  std::vector<std::pair<std::string, std::string>> values;  // the query, in order

  // The last value of that name; empty if there is none.
  [[nodiscard]] std::string_view Value(std::string_view name) const;
};

// Parses a request target such as "/mjpeg?subject=ann&camera=eyes" and decodes percent escapes.
// nullopt: it is not a path, or has an invalid escape.
[[nodiscard]] std::optional<Url> ParseUrl(std::string_view target);

// The request target of the URL: its path and query with percent escapes.
[[nodiscard]] std::string TargetOf(const Url& url);

}  // namespace furrow::server
