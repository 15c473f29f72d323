// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace furrow::server {

// A request's target, taken apart and decoded.
struct Url {
  std::string path;                                         // "/api/explain"
  std::vector<std::pair<std::string, std::string>> values;  // of the query, in order

  // The last of that name; empty where there is none.
  [[nodiscard]] std::string_view Value(std::string_view name) const;
};

// "/mjpeg?subject=ann&camera=eyes". None: no path, or percent signs that mean nothing.
[[nodiscard]] std::optional<Url> ParseUrl(std::string_view target);

}  // namespace furrow::server
