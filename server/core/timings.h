// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "server/core/thread_slot.h"
#include "server/core/time.h"

namespace furrow::server {

// The durations of a daemon that are counted in histograms.
enum class Timing {
  kReceiveToSend,
  kCaptureToSend,
  kPictureWait,
  kPictureDraw,
  kPictureEncode,
  kPictureRequestToSend,
  kCount,
};

struct TimingInfo {
  std::string_view name;   // of the Prometheus family: "furrow_receive_to_send_seconds"
  std::string_view stage;  // value of its label `stage`; empty: the family has no label
  std::string_view help;   // one sentence, equal within a family
};
[[nodiscard]] const TimingInfo& InfoOf(Timing timing);

// Histograms of durations. Any thread may observe and read at any time; observing never blocks.
//
// Each thread writes to its slot (thread_slot.h), and Get() sums the slots.
class Timings {
 public:
  // Upper bounds of the buckets in seconds, a factor of 2 to 2.5 apart: from a local pose to a
  // picture in software.
  static constexpr std::array<double, 17> kBounds = {50e-6, 100e-6, 200e-6, 500e-6, 1e-3, 2e-3,
                                                     5e-3,  10e-3,  20e-3,  50e-3,  0.1,  0.2,
                                                     0.5,   1.0,    2.0,    5.0,    10.0};
  static constexpr std::size_t kBuckets = kBounds.size() + 1;  // the last one has no bound

  // Negative durations count as 0.
  void Observe(Timing timing, Time duration) {
    const std::int64_t nanoseconds = std::max<std::int64_t>(duration.count(), 0);
    const auto bound = std::lower_bound(kBounds.begin(), kBounds.end(), ToSeconds(duration));
    const std::size_t slot = SlotOfThread();
    Histogram& histogram = slots_[slot].histograms[static_cast<std::size_t>(timing)];
    AddInSlot(slot, histogram.counts[static_cast<std::size_t>(bound - kBounds.begin())], 1);
    AddInSlot(slot, histogram.nanoseconds, static_cast<std::uint64_t>(nanoseconds));
  }

  struct Sum {
    std::array<std::uint64_t, kBuckets> counts{};  // of each bucket alone
    double seconds = 0.0;                          // of all durations
  };
  [[nodiscard]] Sum Get(Timing timing) const;

 private:
  struct Histogram {
    std::array<std::atomic<std::uint64_t>, kBuckets> counts{};
    std::atomic<std::uint64_t> nanoseconds = 0;
  };
  struct alignas(64) Slot {
    std::array<Histogram, static_cast<std::size_t>(Timing::kCount)> histograms;
  };

  std::array<Slot, kThreadSlots> slots_;
};

}  // namespace furrow::server
