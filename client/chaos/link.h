// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "protocol/framing/fragment.h"

namespace furrow::chaos {

// An outage: a time span in which no packet passes, once or periodically.
struct BlackHole {
  double start = 0.0;   // seconds since the start of the link
  double length = 0.0;  // seconds
  double every = 0.0;   // seconds from one start to the next; 0: once
};

// Parses "START:LENGTH" or "START:LENGTH:EVERY", in seconds. Errors: kParse.
[[nodiscard]] Result<BlackHole> ParseBlackHole(const std::string& text);

// True if one of `holes` covers the time `seconds` after the start of the link.
[[nodiscard]] bool InBlackHole(std::span<const BlackHole> holes, double seconds);

// The faults to inject. Each fault is drawn independently per packet; probabilities are in [0, 1].
struct Faults {
  std::uint64_t seed = 1;
  double loss = 0.0;       // drop
  double reorder = 0.0;    // hold back until the next packet has passed
  double duplicate = 0.0;  // send twice
  double delay = 0.0;      // hold back for `delay_ms`
  double delay_ms = 1000.0;
  double jitter_ms = 0.0;  // hold back each packet for a random time of up to this
  double falsify = 0.0;    // change one number of a pose or weights message
  double swap = 0.0;       // exchange the contents of two messages of one kind
  std::vector<BlackHole> black_holes;

  // True if any fault is requested.
  [[nodiscard]] bool any() const {
    return loss > 0.0 || reorder > 0.0 || duplicate > 0.0 || delay > 0.0 || jitter_ms > 0.0 ||
           tampers() || !black_holes.empty();
  }
  // True if message contents may change.
  [[nodiscard]] bool tampers() const { return falsify > 0.0 || swap > 0.0; }
};

// The faults injected into the packets of one or more links.
struct FaultCounts {
  std::uint64_t packets = 0;
  std::uint64_t lost = 0;
  std::uint64_t lost_data = 0;  // of `lost`: packets in which IsTamperable() found poses or weights
  std::uint64_t swallowed = 0;  // lost in a black hole
  std::uint64_t reordered = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t delayed = 0;
  std::uint64_t delayed_data = 0;  // of `delayed`, as in `lost_data`
  std::uint64_t falsified = 0;
  std::uint64_t swapped = 0;

  void Add(const FaultCounts& other);
};

// A one-way link that injects faults into the packets that pass. The fate of the i-th packet
// depends only on the seed, the number of the link and i, so a run can be repeated.
//
// If contents may change, the link reassembles fragmented messages and fragments them again on the
// way out. Loss and black holes then apply to fragments, and all other faults apply to the message
// when its last fragment arrives. A message that lost a fragment is not forwarded.
//
// No I/O and no clock: time is a parameter, in microseconds of any monotonic clock. Used by one
// thread at a time.
class Link {
 public:
  // A packet that waits for the next packet is released after this time at the latest.
  static constexpr std::int64_t kLongestHoldUs = 100'000;

  // `number`: identifies the link, so that links with the same seed differ. `start_us`: time 0 of
  // the black holes.
  Link(const Faults& options, std::uint64_t number, std::int64_t start_us)
      : options_(options), number_(number), start_us_(start_us) {}
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // Accepts a packet.
  void Push(std::span<const std::uint8_t> packet, std::int64_t now_us);

  // Takes the next due packet, in due order. Returns false if none is due.
  [[nodiscard]] bool Pop(std::int64_t now_us, std::vector<std::uint8_t>* packet);

  // Time at which the next packet is due; -1: none waits. Call it after Pop() returned false.
  [[nodiscard]] std::int64_t next_us() const {
    return waiting_.empty() ? -1 : waiting_.begin()->first;
  }
  [[nodiscard]] const FaultCounts& counts() const { return counts_; }

 private:
  using Waiting = std::multimap<std::int64_t, std::vector<std::uint8_t>>;  // keyed by due time
  enum class Dice { kLoss, kReorder, kDuplicate, kDelay, kJitter, kFalsify, kSwap, kAmount };

  // A random number in [0, 1) for the current packet and one kind of fault.
  [[nodiscard]] double Roll(Dice dice) const;
  [[nodiscard]] bool Hits(Dice dice, double probability) const {
    return probability > 0.0 && Roll(dice) < probability;
  }
  [[nodiscard]] std::int64_t DueUs(std::span<const std::uint8_t> packet, std::int64_t now_us);
  // Handles a packet, whole or a fragment, that was not lost.
  void Take(std::span<const std::uint8_t> bytes, std::int64_t now_us);
  void Handle(std::span<const std::uint8_t> bytes, std::int64_t now_us);
  void Send(std::vector<std::uint8_t> packet, std::int64_t now_us, std::int64_t due_us);
  [[nodiscard]] bool TakeFirst(std::int64_t now_us);
  void Release(Waiting::iterator* held, std::int64_t due_us);

  Faults options_;
  std::uint64_t number_;
  std::int64_t start_us_;
  FaultCounts counts_;
  Waiting waiting_;
  protocol::Reassembler gathered_;
  // The message that is leaving, the number of its datagrams, and the number already taken.
  std::vector<std::uint8_t> leaving_;
  std::size_t num_datagrams_ = 0;
  std::size_t num_left_ = 0;
  std::uint32_t message_id_ = 0;
  // Packets that wait for the next packet; end(): none.
  Waiting::iterator to_reorder_ = waiting_.end();
  Waiting::iterator to_swap_ = waiting_.end();
};

}  // namespace furrow::chaos
