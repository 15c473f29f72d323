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

// The contents of a take for one subject.
struct SubjectSummary {
  std::size_t joints = 0;  // of its last skeleton
  std::size_t blend_shapes = 0;
  std::size_t skeletons = 0;  // number of different skeletons
  std::set<std::uint64_t> sessions;
  std::size_t poses = 0;
  std::size_t weights = 0;
  std::size_t weight_names = 0;
  std::uint64_t missing = 0;       // gaps in the sequence numbers of one session
  double longest_gap = 0.0;        // seconds of capture time between two poses of one session
  double captured_seconds = 0.0;   // sum of the steps between poses, in capture time
  std::size_t captured_steps = 0;  // number of these steps
  std::size_t unreadable = 0;      // messages that do not decode as their topic's kind
  std::uint64_t first_ns = 0;      // log times of its poses
  std::uint64_t last_ns = 0;

  // Poses per second; 0 if unknown.
  [[nodiscard]] double rate() const {
    return captured_seconds > 0.0 ? static_cast<double>(captured_steps) / captured_seconds : 0.0;
  }
};

struct TakeSummary {
  std::map<std::string, SubjectSummary> subjects;
  std::map<std::string, TakeReader::ForeignTopic> foreign;  // of other programs, by topic
  std::size_t datagrams = 0;
  std::size_t messages = 0;    // of Furrow
  std::uint64_t first_ns = 0;  // log times of all messages
  std::uint64_t last_ns = 0;
  [[nodiscard]] double seconds() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
};

// Reads and decodes every message of a take. Errors: TakeReader::ForEach()'s.
[[nodiscard]] Result<TakeSummary> Summarise(TakeReader& take);

}  // namespace furrow::recording
