// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace furrow::protocol {

// Globs separated by commas over names such as "brow_l.squash": `*` stands for any run of
// characters, `?` for any one; everything else for itself, case counting. Spaces around a glob do
// not count. Empty patterns match nothing. Time is at most the product of the lengths, whatever the
// pattern.
[[nodiscard]] bool MatchesPattern(std::string_view pattern, std::string_view name);

}  // namespace furrow::protocol
