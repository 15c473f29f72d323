// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "protocol/framing/fragment.h"

namespace furrow::load {

// A time in which nothing passes, once or again and again.
struct BlackHole {
  double start = 0.0;   // seconds since the link's start
  double length = 0.0;  // seconds
  double every = 0.0;   // from one start to the next; 0: once
};

// "START:LENGTH" or "START:LENGTH:EVERY", seconds; kParse says what is wrong.
[[nodiscard]] Result<BlackHole> ParseBlackHole(const std::string& text);

// Whether nothing passes so many seconds after the start.
[[nodiscard]] bool InBlackHole(std::span<const BlackHole> holes, double seconds);

// What happens to packets, each by itself with a probability in [0, 1].
struct ChaosOptions {
  std::uint64_t seed = 1;
  double loss = 0.0;
  double reorder = 0.0;    // held back until the next one has passed
  double duplicate = 0.0;  // sent twice
  double delay = 0.0;      // held back for delay_ms
  double delay_ms = 1000.0;
  double jitter_ms = 0.0;  // every packet is held back for up to so long
  double falsify = 0.0;    // a value in a pose or in weights is changed, all else stays valid
  double swap = 0.0;       // two poses or weights exchange their contents
  std::vector<BlackHole> black_holes;

  [[nodiscard]] bool any() const {
    return loss > 0.0 || reorder > 0.0 || duplicate > 0.0 || delay > 0.0 || jitter_ms > 0.0 ||
           tampers() || !black_holes.empty();
  }
  // Whether contents are changed.
  [[nodiscard]] bool tampers() const { return falsify > 0.0 || swap > 0.0; }
};

// What was done to the packets of one link, or of several.
struct ChaosCounts {
  std::uint64_t packets = 0;
  std::uint64_t lost = 0;
  std::uint64_t swallowed = 0;  // by a black hole
  std::uint64_t reordered = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t delayed = 0;
  std::uint64_t falsified = 0;
  std::uint64_t swapped = 0;

  void Add(const ChaosCounts& other);
};

// A link in one direction that mistreats what passes. What happens to the i-th packet follows from
// the seed, the link's number and i alone, so a run can be repeated.
//
// Where contents are changed, messages that come in fragments are put together first and leave in
// fragments again: all but loss and black holes then befalls the message as its last fragment
// comes, and one that lost a fragment, which nobody could read, goes no further.
//
// Pure: time is a parameter (microseconds on any clock that does not go back).
class ChaosLink {
 public:
  // A packet that waits for another goes on after this without it.
  static constexpr std::int64_t kLongestHoldUs = 100'000;

  // `number`: of the link, so that links of one seed differ. `start_us`: what black holes count
  // from.
  ChaosLink(const ChaosOptions& options, std::uint64_t number, std::int64_t start_us)
      : options_(options), number_(number), start_us_(start_us) {}
  ChaosLink(const ChaosLink&) = delete;
  ChaosLink& operator=(const ChaosLink&) = delete;

  // A packet comes in.
  void Push(std::span<const std::uint8_t> packet, std::int64_t now_us);

  // The next packet that is due, in the order they are due; false when none is.
  [[nodiscard]] bool Pop(std::int64_t now_us, std::vector<std::uint8_t>* packet);

  // When the next one is due; -1: none waits.
  // Asked when Pop() has said false.
  [[nodiscard]] std::int64_t next_us() const {
    return waiting_.empty() ? -1 : waiting_.begin()->first;
  }
  [[nodiscard]] const ChaosCounts& counts() const { return counts_; }

 private:
  using Waiting = std::multimap<std::int64_t, std::vector<std::uint8_t>>;  // by when it is due
  enum class Dice { kLoss, kReorder, kDuplicate, kDelay, kJitter, kFalsify, kSwap, kAmount };

  // In [0, 1), of the packet that comes now.
  [[nodiscard]] double Roll(Dice dice) const;
  [[nodiscard]] bool Hits(Dice dice, double probability) const {
    return probability > 0.0 && Roll(dice) < probability;
  }
  [[nodiscard]] std::int64_t DueUs(std::int64_t now_us);
  // A packet that was not lost, whole or as a fragment.
  void Take(std::span<const std::uint8_t> bytes, std::int64_t now_us);
  void Handle(std::span<const std::uint8_t> bytes, std::int64_t now_us);
  void Send(std::vector<std::uint8_t> packet, std::int64_t now_us, std::int64_t due_us);
  [[nodiscard]] bool TakeFirst(std::int64_t now_us);
  void Release(Waiting::iterator* held, std::int64_t due_us);

  ChaosOptions options_;
  std::uint64_t number_;
  std::int64_t start_us_;
  ChaosCounts counts_;
  Waiting waiting_;
  protocol::Reassembler gathered_;
  // What leaves now, and in how many datagrams, of which so many have left.
  std::vector<std::uint8_t> leaving_;
  std::size_t num_datagrams_ = 0;
  std::size_t num_left_ = 0;
  std::uint32_t message_id_ = 0;
  // Those that wait for another packet; end(): none does.
  Waiting::iterator to_reorder_ = waiting_.end();
  Waiting::iterator to_swap_ = waiting_.end();
};

}  // namespace furrow::load
