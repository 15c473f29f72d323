// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {

// Logs once that a port can accept no connections, and once that it can again. Usually the process
// has no file descriptors left.
class AcceptLog {
 public:
  // `port`: "TCP port"; `limit`: the key of the configuration that bounds its connections.
  AcceptLog(std::string port, std::string limit)
      : port_(std::move(port)), limit_(std::move(limit)) {}

  void Failed(const std::string& why) {
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
  bool fails_ = false;
};

}  // namespace furrow::server
