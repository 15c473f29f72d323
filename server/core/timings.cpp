// SPDX-License-Identifier: Apache-2.0
#include "server/core/timings.h"

#include <iterator>

namespace furrow::server {
namespace {

constexpr std::string_view kStages = "furrow_picture_stage_seconds";
constexpr std::string_view kStagesHelp =
    "Time that a picture spent in a stage: wait (until the renderer takes it), draw (until its "
    "pixels have been read back), encode.";

// In the order of the enumeration.
constexpr TimingInfo kTimings[] = {
    {"furrow_receive_to_send_seconds", "",
     "Time from the arrival of a pose, or its release from a jitter buffer, until its weights were "
     "handed to the network."},
    {"furrow_capture_to_send_seconds", "",
     "Time from the capture of a pose until its weights were handed to the network, beyond the "
     "fastest poses of its stream, because the clocks of senders are not synchronised."},
    {kStages, "wait", kStagesHelp},
    {kStages, "draw", kStagesHelp},
    {kStages, "encode", kStagesHelp},
    {"furrow_picture_request_to_send_seconds", "",
     "Time from the request of a picture, which a new pose or a viewer makes, until the picture "
     "was "
     "handed to the network."}};
static_assert(std::size(kTimings) == static_cast<std::size_t>(Timing::kCount));

}  // namespace

const TimingInfo& InfoOf(Timing timing) { return kTimings[static_cast<std::size_t>(timing)]; }

Timings::Sum Timings::Get(Timing timing) const {
  Sum sum;
  std::uint64_t nanoseconds = 0;
  for (const Slot& slot : slots_) {
    const Histogram& histogram = slot.histograms[static_cast<std::size_t>(timing)];
    for (std::size_t i = 0; i < kBuckets; ++i) {
      sum.counts[i] += histogram.counts[i].load(std::memory_order_relaxed);
    }
    nanoseconds += histogram.nanoseconds.load(std::memory_order_relaxed);
  }
  sum.seconds = static_cast<double>(nanoseconds) * 1e-9;
  return sum;
}

}  // namespace furrow::server
