// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "render/graph/frame_graph.h"

namespace furrow::render {

// Milliseconds that one pass of a frame took.
struct PassTime {
  std::string pass;
  double gpu_ms = 0.0;   // between two timestamps of the device's own clock
  double wall_ms = 0.0;  // of this thread, from before the pass until the device had finished it
  double cpu_ms = 0.0;   // of all threads of the process in that time: the work where a processor
                         // draws, which others that use it do not change
};

// Times the passes of frames: Renderer::SetObserver(). It waits for the device before and after
// every pass, so that no pass pays for another; a frame as a whole takes longer than without. A
// software device does part of a pass's work (vertices) on this thread, outside its timestamps, so
// that only wall_ms has all of it.
class PassTimer final : public FrameGraphObserver {
 public:
  PassTimer() = default;
  ~PassTimer() override = default;
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  void BeforePass(std::string_view pass) override;
  void AfterPass(std::string_view pass, const std::vector<Written>& written) override;

  // The passes since the last call, in the order they ran.
  [[nodiscard]] std::vector<PassTime> Take();

 private:
  std::vector<PassTime> times_;
  std::int64_t gpu_start_ = 0;  // ns
  std::chrono::steady_clock::time_point wall_start_;
  std::clock_t cpu_start_ = 0;
};

}  // namespace furrow::render
