// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "render/graph/frame_graph.h"

namespace furrow::render {

// Time that one pass of a frame took, in milliseconds.
struct PassTime {
  std::string pass;
  double gpu_ms = 0.0;   // between two timestamps of the device's clock
  double wall_ms = 0.0;  // wall-clock time of this thread, from before the pass until the device
                         // finished it
  double cpu_ms = 0.0;   // CPU time of all threads of the process. With a software driver this is
                         // the work done, unaffected by other processes.
};

// Measures the passes of frames; install it with Renderer::SetObserver(). It waits for the device
// before and after every pass, so that no pass pays for another. A measured frame therefore takes
// longer than an unmeasured one. A software driver processes vertices on the calling thread,
// outside the timestamps, so only wall_ms and cpu_ms include that work.
class PassTimer final : public FrameGraphObserver {
 public:
  PassTimer() = default;
  ~PassTimer() override = default;
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  void BeforePass(std::string_view pass) override;
  void AfterPass(std::string_view pass, const std::vector<Written>& written) override;

  // Returns the passes since the last call, in the order in which they ran.
  [[nodiscard]] std::vector<PassTime> Take();

 private:
  std::vector<PassTime> times_;
  std::int64_t gpu_start_ = 0;  // ns
  std::chrono::steady_clock::time_point wall_start_;
  std::clock_t cpu_start_ = 0;
};

}  // namespace furrow::render
