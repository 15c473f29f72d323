// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/load/daemon_process.h"
#include "bench/load/load_setup.h"
#include "client/load/compare/comparison.h"
#include "client/load/compare/echo_server.h"

namespace furrow::bench {

// A daemon and two raw echoes on the same cores, for as long as this object lives.
class BesideEchoes {
 public:
  // Exits the program if one of the processes cannot start.
  explicit BesideEchoes(const LoadSetup& setting, const DaemonSetup& setup = {});

  [[nodiscard]] load::ComparisonTargets targets() const;

 private:
  DaemonProcess daemon_;
  load::EchoServer raw_;
  load::EchoServer control_;
};

}  // namespace furrow::bench
