// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/refusal_log.h"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {

void RefusalLog::Note(std::string_view who, std::string_view why, Time now) {
  std::uint64_t left_out = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!bucket_.Take(now)) {
      ++left_out_;
      return;
    }
    left_out = std::exchange(left_out_, 0);
  }
  const std::string others =
      left_out > 0 ? "; " + std::to_string(left_out) + " others were refused before" : "";
  spdlog::warn("refuses {}: {}{}", who, why, others);
}

}  // namespace furrow::server
