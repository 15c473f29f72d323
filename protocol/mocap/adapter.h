// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "protocol/mocap/neutral_frame.h"

namespace furrow::protocol::mocap {

// Numbers of events since the adapter was made.
struct AdapterCounters {
  std::uint64_t accepted = 0;    // frames passed to the sink
  std::uint64_t malformed = 0;   // datagrams or messages that violate the format
  std::uint64_t reordered = 0;   // dropped: older than a frame passed before
  std::uint64_t incomplete = 0;  // frames passed without the sender's end-of-frame message
  std::uint64_t stale = 0;       // dropped: the sender reports that tracking is off
  std::uint64_t ignored = 0;     // valid messages that are not used
};

// Receives frames. The adapter owns the frame, which is valid during the call.
using FrameSink = std::function<void(const NeutralFrame& frame)>;

// Converts datagrams of a foreign mocap protocol to neutral frames. Uses no sockets, no clock and
// no exceptions. Its memory is bounded. Malformed input is counted and changes nothing else.
class MocapAdapter {
 public:
  virtual ~MocapAdapter() = default;

  // Takes one datagram. Calls `sink` once per frame that the datagram completes. `now_us`: arrival
  // in microseconds on any clock that never runs backwards; the same clock for Tick(). An adapter
  // for a protocol that does not identify its senders takes the datagrams of one sender only.
  virtual void Push(std::span<const std::uint8_t> datagram, std::int64_t now_us,
                    const FrameSink& sink) = 0;
  // Passes a frame to `sink` if it has waited too long for its end. Call it about every 10 ms.
  virtual void Tick(std::int64_t now_us, const FrameSink& sink) = 0;
  // Discards the state of the current sender because another sender follows.
  // NeutralFrame::sequence and ::layout continue to count. Does nothing if the protocol identifies
  // its senders.
  virtual void Forget() {}

  [[nodiscard]] const AdapterCounters& counters() const { return counters_; }

 protected:
  AdapterCounters counters_;
};

}  // namespace furrow::protocol::mocap
