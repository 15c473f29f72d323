// SPDX-License-Identifier: Apache-2.0
#include "render/gl/pass_timer.h"

#include <utility>

#include "render/gl/gl_objects.h"

namespace furrow::render {
namespace {

// Waits until all submitted work is done. Returns the device's clock in nanoseconds.
std::int64_t Timestamp() {
  GLuint query = 0;
  glCreateQueries(GL_TIMESTAMP, 1, &query);
  glQueryCounter(query, GL_TIMESTAMP);
  GLint64 time = 0;
  glGetQueryObjecti64v(query, GL_QUERY_RESULT, &time);  // waits
  glDeleteQueries(1, &query);
  return time;
}

}  // namespace

void PassTimer::BeforePass(std::string_view) {
  glFinish();
  gpu_start_ = Timestamp();
  cpu_start_ = std::clock();
  wall_start_ = std::chrono::steady_clock::now();
}

void PassTimer::AfterPass(std::string_view pass, const std::vector<Written>&) {
  const std::int64_t gpu_end = Timestamp();
  glFinish();
  const std::chrono::duration<double, std::milli> wall =
      std::chrono::steady_clock::now() - wall_start_;
  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
  times_.push_back(
      {std::string(pass), static_cast<double>(gpu_end - gpu_start_) * 1e-6, wall.count(), cpu_ms});
}

std::vector<PassTime> PassTimer::Take() { return std::exchange(times_, {}); }

}  // namespace furrow::render
