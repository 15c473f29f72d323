// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "base/status.h"
#include "client/chaos/proxy.h"
#include "client/load/run/run.h"

namespace furrow::cli {

// The faults injected into the traffic to the daemon (up) and from it (down).
struct InjectedFaults {
  chaos::Outcome up;
  chaos::Outcome down;
};

// A chaos proxy between this program and the daemon. It runs on its own thread.
class InProcessProxy {
 public:
  InProcessProxy() = default;
  InProcessProxy(const InProcessProxy&) = delete;
  InProcessProxy& operator=(const InProcessProxy&) = delete;
  ~InProcessProxy() { (void)Stop(); }

  // If `up` or `down` requests faults, starts the proxy and changes the address in `target` to the
  // proxy's. Errors: those of chaos::Proxy::Open(); `target` is unchanged then.
  [[nodiscard]] Status Start(const chaos::Faults& up, const chaos::Faults& down,
                             load::Target* target);

  // Stops the proxy and returns what it injected; nothing if it is not running.
  std::optional<InjectedFaults> Stop();

 private:
  std::unique_ptr<chaos::Proxy> proxy_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace furrow::cli
