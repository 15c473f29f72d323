// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "client/load/run/run.h"

namespace furrow::bench {

// A furrowd of our own on free ports, on the machine's first core alone, or with several threads on
// so many, but never on the last; this program moves to all but the first when the first one is
// started. Ended with the object.
class DaemonProcess {
 public:
  // `program`: furrowd. `folder`: for its configuration, which lifts the limits of subjects.
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
