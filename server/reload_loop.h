// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>

#include "base/status.h"
#include "server/core/metrics.h"
#include "server/machine/service_manager.h"
#include "server/reload.h"

namespace furrow::server {

// Reads the configuration again on SIGHUP, one reload at a time: another SIGHUP meanwhile begins
// the next one. Files are read on a thread of their own, because poses must not wait for them. A
// SIGHUP of a terminal that has closed shuts the daemon down instead. All functions and callbacks
// belong to the thread of the event loop.
class ReloadLoop {
 public:
  struct Parts {
    asio::io_context* io = nullptr;
    Metrics* metrics = nullptr;
    ServiceManager* manager = nullptr;         // null: none
    std::function<ReloadRequest()> request;    // what to read
    std::function<Status(Reload*)> take_over;  // its failure leaves all as it was
    std::function<bool()> is_draining;         // then nothing is read or taken over
    std::function<void()> shut_down;           // the terminal has closed
  };
  explicit ReloadLoop(Parts parts);

  void Start();
  // Call it about once per second: a terminal that was there at the last look and is not there now
  // has closed.
  void LookAtTerminal();
  // The last reload left the configuration as it was.
  [[nodiscard]] bool is_refused() const { return is_refused_; }

 private:
  asio::awaitable<void> Run();
  void Begin();
  void Read();
  void End(Result<Reload> reload);

  const Parts parts_;
  asio::signal_set hangups_;
  bool has_terminal_;  // at the last look
  bool is_reading_ = false;
  bool is_refused_ = false;
  bool reads_again_ = false;  // SIGHUP came while a reload was under way
  std::jthread reader_;       // posts to the event loop; ends before the members above
};

}  // namespace furrow::server
