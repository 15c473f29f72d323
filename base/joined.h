// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ranges>
#include <string>

namespace furrow {

// The items as a list for a message: "a, b, c". `text`: a function or member that gives an item's
// text; by default, the items are texts.
template <std::ranges::input_range Items, class Text = std::identity>
[[nodiscard]] std::string Joined(const Items& items, const Text& text = {}) {
  std::string joined;
  for (const auto& item : items) {
    if (!joined.empty()) joined += ", ";
    joined += std::invoke(text, item);
  }
  return joined;
}

}  // namespace furrow
