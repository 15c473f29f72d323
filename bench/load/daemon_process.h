// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "client/load/run/run.h"

namespace furrow::bench {

// A furrowd process on free ports. It runs on the first core only, or on one core per thread except
// the last core. When the first daemon starts, this program moves to all cores but the first. The
// destructor ends the process.
class DaemonProcess {
 public:
  // `program`: furrowd. `folder`: receives its configuration, which lifts the limits on subjects.
  [[nodiscard]] static Result<DaemonProcess> Start(const std::filesystem::path& program,
                                                   const std::filesystem::path& rig,
                                                   const std::filesystem::path& folder,
                                                   int threads = 1);
  ~DaemonProcess();
  DaemonProcess(DaemonProcess&& other) noexcept;
  DaemonProcess& operator=(DaemonProcess&&) = delete;

  [[nodiscard]] const load::Target& target() const { return target_; }

 private:
  explicit DaemonProcess(load::Target target) : target_(std::move(target)) {}

  load::Target target_;
};

}  // namespace furrow::bench
