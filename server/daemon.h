// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "server/config/config.h"
#include "server/core/exit_code.h"
#include "server/core/metrics.h"
#include "server/machine/service_manager.h"
#include "server/reload.h"

namespace furrow::server {

// What a running daemon serves. A port that is absent: the service is off.
struct Ready {
  std::uint16_t tcp = 0;
  std::uint16_t udp = 0;
  std::optional<std::uint16_t> vmc;
  std::optional<std::uint16_t> livelink_face;
  std::optional<std::uint16_t> http;
  bool render = false;  // a renderer is running
};

// The options of Run() that are not part of the configuration.
struct RunOptions {
  std::stop_token stop;         // requests a shutdown, as SIGTERM does
  bool handle_signals = false;  // shut down on SIGTERM and SIGINT, reload on SIGHUP
  ReadConfig reload;            // how SIGHUP reads the configuration again; empty: not at all
  bool confine = false;         // the process is the daemon's own: SecurityConfig::confine applies
  std::function<void(const Ready&)>
      on_ready;                         // called on the calling thread once the daemon serves
  Metrics* metrics = nullptr;           // used instead of the daemon's own; optional
  ServiceManager* manager = nullptr;    // hears how the daemon is; optional
  ServiceManager::Listeners listeners;  // used instead of the configured addresses
};

// Runs a daemon: loads its files, listens, prints 'furrowd ready ...' on stdout, serves until it is
// asked to stop, then sends what is still queued and closes the connections. Errors are logged
// before the function returns.
//
// The calling thread becomes the network thread of shard 0 (a shard is one network thread's share
// of the subjects). Further threads: Config::threads - 1 that receive UDP, one that renders, one
// for the web server, one for the recorder. Several daemons may run in one process.
[[nodiscard]] ExitCode Run(const Config& config, const RunOptions& options = {});

}  // namespace furrow::server
