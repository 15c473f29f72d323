// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::load {

// How a recording is sent again and again by many subjects.
struct PlanOptions {
  int subjects = 1;
  int phases = 1;         // how many different places of the recording they start at
  double rate = 0.0;      // poses a second of each subject; 0: the recording's own spacing
  double seconds = 10.0;  // no pose is due at or after it
};

// Which pose of which subject is due when: fixed before the first one is sent, so that a server
// that is slow delays nothing but itself (an open loop, no coordinated omission).
//
// Subjects start evenly spread over the recording and over one interval between poses, so that
// their poses do not come in bursts. Times are whole microseconds and the same in every round, and
// so are the steps between capture times.
class Plan {
 public:
  struct Slot {
    std::int64_t due_us = 0;  // from the start
    std::uint32_t subject = 0;
    std::uint32_t pose = 0;  // of the subject, from 0
  };

  // `times`: of the recording's frames, seconds, increasing; at least one.
  Plan(std::span<const double> times, const PlanOptions& options);

  // Poses of all subjects.
  [[nodiscard]] std::uint64_t num_slots() const { return num_slots_; }
  [[nodiscard]] int num_subjects() const { return static_cast<int>(counts_.size()); }
  // Poses of one subject.
  [[nodiscard]] std::uint32_t count(std::uint32_t subject) const { return counts_[subject]; }
  [[nodiscard]] int num_frames() const { return static_cast<int>(frame_us_.size()); }
  [[nodiscard]] int num_phases() const { return phases_; }
  [[nodiscard]] int phase_of(std::uint32_t subject) const {
    return static_cast<int>(subject) % phases_;
  }
  // The recording's frame that is pose `pose` of a subject that starts at `phase`.
  [[nodiscard]] int Frame(int phase, std::uint32_t pose) const;
  // When that pose was captured: microseconds since the subject's first.
  [[nodiscard]] std::int64_t CaptureUs(int phase, std::uint32_t pose) const;
  // When it is due, from the start of the run.
  [[nodiscard]] std::int64_t DueUs(std::uint32_t subject, std::uint32_t pose) const;
  // Of all subjects, on average.
  [[nodiscard]] double poses_per_second() const;

 private:
  [[nodiscard]] int FirstFrame(int phase) const;
  [[nodiscard]] std::uint32_t CountBefore(std::uint32_t subject, std::int64_t end_us) const;

  int phases_;
  double seconds_;
  std::vector<std::int64_t> frame_us_;  // of each frame in its round
  std::int64_t round_us_;
  std::vector<std::int64_t> offset_us_;  // of each subject
  std::vector<std::uint32_t> counts_;
  std::uint64_t num_slots_ = 0;
};

// The slots of a plan, one after the other as they are due; of one time, in the order of the
// subjects. Memory: one slot a subject, however long the plan.
//
//   for (PlanSlots slots(plan); !slots.done(); slots.Pop()) Send(slots.next());
class PlanSlots {
 public:
  // `plan` outlives it.
  explicit PlanSlots(const Plan& plan);

  [[nodiscard]] bool done() const { return heap_.empty(); }
  // Precondition of both: not done().
  [[nodiscard]] const Plan::Slot& next() const { return heap_.front(); }
  void Pop();

 private:
  const Plan* plan_;
  std::vector<Plan::Slot> heap_;  // the next one of each subject
};

}  // namespace furrow::load
