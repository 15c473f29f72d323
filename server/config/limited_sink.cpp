// SPDX-License-Identifier: Apache-2.0
#include "server/config/limited_sink.h"

#include <chrono>
#include <utility>

namespace furrow::server {

LimitedSink::~LimitedSink() { LogDropped(last_time_); }

void LimitedSink::sink_it_(const spdlog::details::log_msg& message) {
  last_time_ = message.time;
  // A clock that was set back gives no tokens until it catches up; errors still pass.
  const Time now = std::chrono::duration_cast<Time>(message.time.time_since_epoch());
  const bool passes = bucket_.Take(now);
  if (!passes && message.level < spdlog::level::err) {
    ++dropped_;
    return;
  }
  // Before the line, so that the gap shows at its place.
  if (passes) LogDropped(message.time);
  below_->log(message);
}

void LimitedSink::LogDropped(spdlog::log_clock::time_point time) {
  if (dropped_ == 0) return;
  const std::string text = std::to_string(std::exchange(dropped_, 0)) +
                           " log lines were dropped because of the rate limit";
  below_->log({time, spdlog::source_loc(), "furrowd", spdlog::level::warn, text});
}

}  // namespace furrow::server
