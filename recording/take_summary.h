// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "base/status.h"
#include "recording/take_reader.h"

namespace furrow::recording {

// What a take holds of one subject.
struct SubjectSummary {
  std::size_t joints = 0;  // of its last skeleton
  std::size_t blend_shapes = 0;
  std::size_t skeletons = 0;  // different ones
  std::set<std::uint64_t> sessions;
  std::size_t poses = 0;
  std::size_t weights = 0;
  std::size_t weight_names = 0;
  std::uint64_t missing = 0;       // numbers that were left out between poses of one session
  double longest_gap = 0.0;        // seconds between two poses of one session, as captured
  double captured_seconds = 0.0;   // from pose to pose within the sessions, as captured
  std::size_t captured_steps = 0;  // how many steps those are
  std::size_t unreadable = 0;      // messages that are not what their topic says
  std::uint64_t first_ns = 0;      // log times of its poses
  std::uint64_t last_ns = 0;

  // Poses a second; 0 where one cannot tell.
  [[nodiscard]] double rate() const {
    return captured_seconds > 0.0 ? static_cast<double>(captured_steps) / captured_seconds : 0.0;
  }
};

struct TakeSummary {
  std::map<std::string, SubjectSummary> subjects;
  std::size_t datagrams = 0;
  std::size_t messages = 0;
  std::uint64_t first_ns = 0;  // log times
  std::uint64_t last_ns = 0;
  [[nodiscard]] double seconds() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
};

// Reads the whole take, and every message in it. Errors: the reader's.
[[nodiscard]] Result<TakeSummary> Summarise(TakeReader& take);

}  // namespace furrow::recording
