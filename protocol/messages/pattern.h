// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace furrow::protocol {

// Takes the first glob off a comma-separated list, without the spaces around it. It may be empty.
// The rest of `pattern` is empty after the last glob.
[[nodiscard]] std::string_view NextGlob(std::string_view* pattern);

// Matches `name` (such as "brow_l.squash") against a comma-separated list of globs. `*` matches any
// run of characters and `?` any one character; other characters match themselves, case-sensitively.
// Spaces around a glob are ignored. An empty pattern matches nothing. The running time is at most
// proportional to the product of the two lengths, so a hostile pattern is harmless.
[[nodiscard]] bool MatchesPattern(std::string_view pattern, std::string_view name);

}  // namespace furrow::protocol
