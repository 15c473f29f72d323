// SPDX-License-Identifier: Apache-2.0
#include "server/core/jitter_rule.h"

#include <charconv>
#include <system_error>

namespace furrow::server {

Result<JitterRule> ParseJitterRule(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  JitterRule rule;
  if (equals != text.npos) rule.subjects = text.substr(0, equals);
  const std::string_view number = equals == text.npos ? text : text.substr(equals + 1);
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), rule.delay_ms);
  // The comparison is written so that NaN fails.
  const bool in_range = rule.delay_ms >= 0.0 && rule.delay_ms <= kMaxJitterDelayMs;
  if (error != std::errc() || end != number.data() + number.size() || !in_range ||
      rule.subjects.empty()) {
    return Status(StatusCode::kInvalidArgument,
                  "'" + std::string(text) + "' is not MS or SUBJECTS=MS, with MS from 0 to 1000",
                  "", "for example 60 or 'phone-*=80'");
  }
  return rule;
}

}  // namespace furrow::server
