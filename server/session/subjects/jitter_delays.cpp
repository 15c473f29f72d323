// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/jitter_delays.h"

#include <algorithm>
#include <ranges>

#include "protocol/messages/pattern.h"

namespace furrow::server {

bool JitterDelays::any() const {
  return std::ranges::any_of(rules_, [](const JitterRule& rule) { return rule.delay_ms > 0.0; });
}

Time JitterDelays::Of(std::string_view subject) const {
  for (const JitterRule& rule : std::views::reverse(rules_)) {
    if (protocol::MatchesPattern(rule.subjects, subject)) return FromSeconds(rule.delay_ms * 1e-3);
  }
  return Time{0};
}

}  // namespace furrow::server
