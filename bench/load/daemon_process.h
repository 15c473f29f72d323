// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "client/load/run/run.h"

namespace furrow::bench {

// The cores that this program could use at first, before it moved to some of them.
[[nodiscard]] int NumCores();

// How a daemon runs.
struct DaemonSetup {
  int threads = 1;
  // True: on the first core only, or on one core per thread except the last core; this program
  // moves to the other cores. False: on any core.
  bool is_pinned = true;
  int busy_poll_us = 0;
  std::filesystem::path keys;  // of tokens; empty: none
};

// A furrowd process on free ports. The destructor ends the process.
class DaemonProcess {
 public:
  // `program`: furrowd. `folder`: receives its configuration, which lifts the limits on subjects.
  [[nodiscard]] static Result<DaemonProcess> Start(const std::filesystem::path& program,
                                                   const std::filesystem::path& rig,
                                                   const std::filesystem::path& folder,
                                                   const DaemonSetup& setup = {});
  ~DaemonProcess();
  DaemonProcess(DaemonProcess&& other) noexcept;
  DaemonProcess& operator=(DaemonProcess&&) = delete;

  [[nodiscard]] const load::Target& target() const { return target_; }

 private:
  explicit DaemonProcess(load::Target target) : target_(std::move(target)) {}

  load::Target target_;
};

}  // namespace furrow::bench
