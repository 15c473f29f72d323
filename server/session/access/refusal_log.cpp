// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/refusal_log.h"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {

std::optional<std::uint64_t> RefusalLog::Take(Time now) {
  const std::lock_guard lock(mutex_);
  if (!bucket_.Take(now)) {
    ++left_out_;
    return std::nullopt;
  }
  return std::exchange(left_out_, 0);
}

void RefusalLog::Write(std::string_view who, std::string_view why, std::uint64_t left_out) {
  const std::string others =
      left_out > 0 ? "; " + std::to_string(left_out) + " others were refused before" : "";
  spdlog::warn("refused {}: {}{}", who, why, others);
}

}  // namespace furrow::server
