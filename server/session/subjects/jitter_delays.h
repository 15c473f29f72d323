// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "server/core/jitter_rule.h"
#include "server/core/time.h"

namespace furrow::server {

// The delays of jitter buffers by subject.
class JitterDelays {
 public:
  explicit JitterDelays(std::vector<JitterRule> rules) : rules_(std::move(rules)) {}

  // True if some subject may have a buffer.
  [[nodiscard]] bool any() const;
  // The delay of the last rule for the subject; 0: no buffer.
  [[nodiscard]] Time Of(std::string_view subject) const;

 private:
  std::vector<JitterRule> rules_;
};

}  // namespace furrow::server
