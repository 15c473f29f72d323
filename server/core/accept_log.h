// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/core/metrics.h"

namespace furrow::server {

// Logs once that a port can accept no connections, and once that it can again, and counts the
// failures. Usually the process has no file descriptors left.
class AcceptLog {
 public:
  // `port`: "TCP port"; `limit`: the key of the configuration that bounds its connections;
  // `metrics`: outlives this object.
  AcceptLog(std::string port, std::string limit, Metrics* metrics)
      : port_(std::move(port)), limit_(std::move(limit)), metrics_(metrics) {}

  void Failed(const std::string& why) {
    metrics_->Add(Counter::kAcceptsFailed);
    if (std::exchange(fails_, true)) return;
    spdlog::warn("the {} accepts no connections: {}; raise LimitNOFILE= or lower {}", port_, why,
                 limit_);
  }
  void Accepted() {
    if (std::exchange(fails_, false)) spdlog::info("the {} accepts connections again", port_);
  }

 private:
  const std::string port_;
  const std::string limit_;
  Metrics* const metrics_;
  bool fails_ = false;
};

}  // namespace furrow::server
