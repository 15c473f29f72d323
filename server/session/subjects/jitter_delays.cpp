// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/jitter_delays.h"

#include <algorithm>

#include "protocol/messages/pattern.h"

namespace furrow::server {

bool JitterDelays::any() const {
  return std::ranges::any_of(rules_, [](const JitterRule& rule) { return rule.delay_ms > 0.0; });
}

Time JitterDelays::Of(std::string_view subject) const {
  const auto rule = std::find_if(rules_.rbegin(), rules_.rend(), [=](const JitterRule& each) {
    return protocol::MatchesPattern(each.subjects, subject);
  });
  return rule == rules_.rend() ? Time{0} : FromSeconds(rule->delay_ms * 1e-3);
}

}  // namespace furrow::server
