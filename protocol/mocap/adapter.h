// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "protocol/mocap/neutral_frame.h"

namespace furrow::protocol::mocap {

struct AdapterCounters {
  std::uint64_t accepted = 0;    // frames given to the sink
  std::uint64_t malformed = 0;   // datagrams or messages that are not what the format says
  std::uint64_t reordered = 0;   // older than what was given already: dropped
  std::uint64_t incomplete = 0;  // frames given without the sender's own mark of the end
  std::uint64_t stale = 0;       // frames of a sender that says its tracking is off: dropped
  std::uint64_t ignored = 0;     // valid, but nothing we use
};

// The frame is the adapter's and valid during the call.
using FrameSink = std::function<void(const NeutralFrame& frame)>;

// A foreign wire: bytes in, neutral frames out. No sockets, no clock, no exceptions; every memory
// is bounded; malformed input is counted and changes nothing else.
class MocapAdapter {
 public:
  virtual ~MocapAdapter() = default;

  // One datagram of one sender. Calls `sink` once for each frame that it completes.
  virtual void Push(std::span<const std::uint8_t> datagram, std::int64_t now_us,
                    const FrameSink& sink) = 0;
  // Gives out what waited too long for its end. Call it every 10 ms or so.
  virtual void Tick(std::int64_t now_us, const FrameSink& sink) = 0;
  // Another sender follows: what the last one said counts no more. Frames and layouts are numbered
  // on. Nothing to do where the wire tells its senders apart.
  virtual void Forget() {}

  [[nodiscard]] const AdapterCounters& counters() const { return counters_; }

 protected:
  AdapterCounters counters_;
};

}  // namespace furrow::protocol::mocap
