// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::load {

// The size of a load test: subjects that all send one recording, repeated in rounds.
struct PlanOptions {
  int subjects = 1;
  int phases = 1;         // number of different start frames, >= 1
  double rate = 0.0;      // poses per second and subject; 0: the recording's own spacing
  double seconds = 10.0;  // length of the run
  // The capture clocks jump by `clock_step` seconds after each `clock_every` seconds, forwards and
  // backwards in turn. 0: never.
  double clock_step = 0.0;
  double clock_every = 5.0;  // > 0
};

// The due times of all poses of all subjects, fixed before the first pose is sent. A slow server
// therefore does not slow down the load: this is an open-loop test without coordinated omission
// (Tene, "How NOT to Measure Latency").
//
// The subjects' start frames are spread evenly over the recording, and their start times over one
// interval between poses, so that poses do not come in bursts. All times are whole microseconds.
// Due times and capture-time steps repeat exactly in every round.
class Plan {
 public:
  struct Slot {
    std::int64_t due_us = 0;  // since the start of the run
    std::uint32_t subject = 0;
    std::uint32_t pose = 0;  // number within the subject, from 0
  };

  // `times`: frame times of the recording, in seconds, increasing; at least one.
  Plan(std::span<const double> times, const PlanOptions& options);

  // Number of poses of all subjects.
  [[nodiscard]] std::uint64_t num_slots() const { return num_slots_; }
  [[nodiscard]] int num_subjects() const { return static_cast<int>(counts_.size()); }
  // Number of poses of one subject.
  [[nodiscard]] std::uint32_t count(std::uint32_t subject) const { return counts_[subject]; }
  [[nodiscard]] int num_frames() const { return static_cast<int>(frame_us_.size()); }
  [[nodiscard]] int num_phases() const { return phases_; }
  // The start phase of a subject, in [0, num_phases()).
  [[nodiscard]] int phase_of(std::uint32_t subject) const {
    return static_cast<int>(subject) % phases_;
  }
  // The frame that is sent as pose `pose` of a subject with start `phase`.
  [[nodiscard]] int Frame(int phase, std::uint32_t pose) const;
  // Capture time of pose `pose` of a subject with start `phase`, in microseconds since the
  // subject's first pose, on a clock that does not jump.
  [[nodiscard]] std::int64_t CaptureUs(int phase, std::uint32_t pose) const;
  // How far the capture clock has jumped before a pose is due, microseconds. Its capture time is
  // CaptureUs() plus this.
  [[nodiscard]] std::int64_t ClockOffsetUs(std::uint32_t subject, std::uint32_t pose) const;
  // Due time in microseconds since the start of the run.
  [[nodiscard]] std::int64_t DueUs(std::uint32_t subject, std::uint32_t pose) const;
  // Average rate of all subjects together, poses per second.
  [[nodiscard]] double poses_per_second() const;

 private:
  [[nodiscard]] int FirstFrame(int phase) const;
  [[nodiscard]] std::uint32_t CountBefore(std::uint32_t subject, std::int64_t end_us) const;

  int phases_;
  double seconds_;
  std::int64_t clock_step_us_;
  std::int64_t clock_every_us_;
  std::vector<std::int64_t> frame_us_;  // time of each frame within a round
  std::int64_t round_us_;
  std::vector<std::int64_t> offset_us_;  // start time of each subject
  std::vector<std::uint32_t> counts_;
  std::uint64_t num_slots_ = 0;
};

// Iterates over the slots of a plan in due order; slots with equal times come in subject order.
// Keeps one slot per subject in memory, whatever the length of the plan.
//
//   for (PlanSlots slots(plan); !slots.done(); slots.Pop()) Send(slots.next());
class PlanSlots {
 public:
  // `plan` must outlive this object.
  explicit PlanSlots(const Plan& plan);

  [[nodiscard]] bool done() const { return heap_.empty(); }
  // Precondition of next() and Pop(): not done().
  [[nodiscard]] const Plan::Slot& next() const { return heap_.front(); }
  void Pop();

 private:
  const Plan* plan_;
  std::vector<Plan::Slot> heap_;  // next slot of each subject
};

}  // namespace furrow::load
