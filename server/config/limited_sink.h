// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <spdlog/sinks/base_sink.h>

#include "server/shares/token_bucket.h"

namespace furrow::server {

// Limits log lines to kLinesPerSecond on average and kBurst at once, so that no peer can fill a
// disk with log lines. The next line that passes is preceded by the number of dropped lines. Errors
// always pass. The times of the messages are the clock, so tests choose it.
class LimitedSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  // 100 lines of 100 bytes per second fill less than 1 GB per day.
  static constexpr double kLinesPerSecond = 100.0;
  static constexpr double kBurst = 1000.0;

  // `below`: receives the lines that pass; not null.
  explicit LimitedSink(spdlog::sink_ptr below) : below_(std::move(below)) {}
  ~LimitedSink() override;
  // How often everything before was written; thread-safe.
  [[nodiscard]] std::uint64_t flushes() const { return flushes_; }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {
    below_->flush();
    ++flushes_;
  }
  void set_pattern_(const std::string& pattern) override { below_->set_pattern(pattern); }
  void set_formatter_(std::unique_ptr<spdlog::formatter> formatter) override {
    below_->set_formatter(std::move(formatter));
  }

 private:
  void LogDropped(spdlog::log_clock::time_point time);

  const spdlog::sink_ptr below_;
  TokenBucket bucket_{kLinesPerSecond, kBurst};
  std::uint64_t dropped_ = 0;
  std::atomic<std::uint64_t> flushes_ = 0;
  spdlog::log_clock::time_point last_time_{};
};

}  // namespace furrow::server
