// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/frame_times.h"

#include <algorithm>
#include <utility>

namespace furrow::authoring {
namespace {

// Seconds. Floats, which glTF uses for times, resolve the first for an hour.
constexpr double kSameFrame = 5e-4;
constexpr double kDense = 0.07;

void SortFrames(std::vector<double>* times) {
  std::sort(times->begin(), times->end());
  times->erase(std::unique(times->begin(), times->end(),
                           [](double a, double b) { return b - a < kSameFrame; }),
               times->end());
}

}  // namespace

void FrameTimes::Add(std::vector<double> seconds) {
  SortFrames(&seconds);
  std::vector<Frame> merged;
  merged.reserve(std::max(frames_.size(), seconds.size()));
  auto old = frames_.begin();
  for (const double time : seconds) {
    while (old != frames_.end() && old->seconds <= time - kSameFrame) merged.push_back(*old++);
    if (old != frames_.end() && old->seconds < time + kSameFrame) {
      merged.push_back({old->seconds, old->joints + 1});
      ++old;
    } else {
      merged.push_back({time, 1});
    }
  }
  merged.insert(merged.end(), old, frames_.end());
  frames_ = std::move(merged);
}

std::vector<double> FrameTimes::WithoutAddedKeys() const {
  std::size_t most = 0;
  for (const Frame& frame : frames_) most = std::max(most, frame.joints);
  std::vector<double> times;
  std::size_t kept = 0;  // of `times`, up to the last frame that most joints have
  bool is_after_full = false;
  for (const Frame& frame : frames_) {
    const bool is_full = 2 * frame.joints >= most;
    if (is_full && is_after_full && frame.seconds - times[kept - 1] <= kDense) times.resize(kept);
    times.push_back(frame.seconds);
    if (!is_full) continue;
    kept = times.size();
    is_after_full = true;
  }
  return times;
}

std::vector<double> FrameTimes::Finish(double end) const {
  std::vector<double> times = WithoutAddedKeys();
  const bool cut_start = !times.empty() && times.front() < -kSameFrame;
  const bool cut_end = !times.empty() && end > 0.0 && times.back() > end + kSameFrame;
  std::erase_if(times, [&](double time) {
    return time < -kSameFrame || (end > 0.0 && time > end + kSameFrame);
  });
  if (cut_start || times.empty()) times.push_back(0.0);
  if (cut_end) times.push_back(end);
  SortFrames(&times);
  return times;
}

}  // namespace furrow::authoring
