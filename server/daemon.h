// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "server/config/config.h"
#include "server/core/exit_code.h"
#include "server/core/metrics.h"

namespace furrow::server {

// Where a daemon that serves is to be reached.
struct Ready {
  std::uint16_t tcp = 0;
  std::uint16_t udp = 0;
  std::optional<std::uint16_t> vmc;
  std::optional<std::uint16_t> livelink_face;
  std::optional<std::uint16_t> http;
  bool render = false;
};

struct RunOptions {
  std::stop_token stop;                        // asks for what SIGTERM asks for
  bool handle_signals = false;                 // SIGTERM and SIGINT drain; for a process of its own
  std::function<void(const Ready&)> on_ready;  // on the calling thread, once it serves
  Metrics* metrics = nullptr;                  // counted into instead of a set of its own
};

// The daemon, whole: loads, listens, prints 'furrowd ready ...' on stdout, serves until it is asked
// to stop, drains, returns how it ended. Errors are logged before it returns.
//
// The calling thread becomes the first network thread, Config::threads - 1 more take in datagrams;
// the render thread is its own. Several daemons may run in one process.
[[nodiscard]] ExitCode Run(const Config& config, const RunOptions& options = {});

}  // namespace furrow::server
