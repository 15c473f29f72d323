// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "base/status.h"
#include "client/chaos/proxy.h"
#include "client/load/run.h"

namespace furrow::cli {

// What was done to datagrams and TCP connections, to the daemon and from it.
struct Planted {
  load::ChaosOutcome up;
  load::ChaosOutcome down;
};

// A chaos proxy between this program and the daemon, on a thread of its own while it lives.
class OwnChaos {
 public:
  OwnChaos() = default;
  OwnChaos(const OwnChaos&) = delete;
  OwnChaos& operator=(const OwnChaos&) = delete;
  ~OwnChaos() { (void)End(); }

  // Turns `target` to the proxy where either way asks for chaos. Errors: of ChaosProxy::Open().
  [[nodiscard]] Status Start(const load::ChaosOptions& up, const load::ChaosOptions& down,
                             load::Target* target);

  // What was done; nothing without chaos, and when it is called again.
  std::optional<Planted> End();

 private:
  std::unique_ptr<load::ChaosProxy> proxy_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace furrow::cli
