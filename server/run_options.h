// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

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
  bool owns_process = false;    // nothing but the daemon runs in this process
  std::string confined;         // what Confine() returned; empty: FinishConfinement() is not called
  std::function<void(const Ready&)>
      on_ready;                         // called on the calling thread once the daemon serves
  Metrics* metrics = nullptr;           // used instead of the daemon's own; optional
  ServiceManager* manager = nullptr;    // hears how the daemon is; optional
  ServiceManager::Listeners listeners;  // used instead of the configured addresses
  ServiceManager::Kept kept;            // what the former daemon has left; needs `manager`
};

}  // namespace furrow::server
