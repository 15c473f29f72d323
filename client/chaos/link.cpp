// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/link.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "client/chaos/tamper.h"
#include "protocol/framing/envelope.h"

namespace furrow::chaos {
namespace {

// Turns a counter into independent random bits. Unlike a generator with a state, it gives packet i
// the same fate whatever happened to the packets before it.
// Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators" (2014).
std::uint64_t Mix(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15ULL;
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9ULL;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBULL;
  return value ^ (value >> 31);
}

// Number of datagrams that carry a packet. A reassembled message may need several; a packet that is
// not a message passes unchanged.
std::size_t NumDatagrams(std::span<const std::uint8_t> packet) {
  protocol::Envelope envelope;
  const bool is_message =
      protocol::ReadEnvelope(packet, envelope) == protocol::EnvelopeStatus::kOk &&
      packet.size() == protocol::kEnvelopeBytes + envelope.payload_bytes;
  return is_message ? protocol::NumDatagrams(packet.size()) : 1;
}

}  // namespace

Result<BlackHole> ParseBlackHole(const std::string& text) {
  BlackHole hole;
  int used = 0;
  // %n stores the number of characters read so far, which shows whether anything follows.
  const int fields = std::sscanf(text.c_str(), "%lf:%lf%n:%lf%n", &hole.start, &hole.length, &used,
                                 &hole.every, &used);
  // The comparisons are written so that NaN fails.
  const bool whole = fields >= 2 && used == static_cast<int>(text.size());
  if (!whole || !(hole.start >= 0.0) || !(hole.length > 0.0) ||
      (fields == 3 && !(hole.every > hole.length))) {
    return Status(StatusCode::kParse,
                  "'" + text +
                      "' is not START:LENGTH or START:LENGTH:EVERY, in seconds, with EVERY "
                      "greater than LENGTH");
  }
  return hole;
}

bool InBlackHole(std::span<const BlackHole> holes, double seconds) {
  return std::ranges::any_of(holes, [seconds](const BlackHole& hole) {
    const double since = seconds - hole.start;
    if (since < 0.0) return false;
    return (hole.every > 0.0 ? std::fmod(since, hole.every) : since) < hole.length;
  });
}

void FaultCounts::Add(const FaultCounts& other) {
  packets += other.packets;
  lost += other.lost;
  lost_data += other.lost_data;
  swallowed += other.swallowed;
  reordered += other.reordered;
  duplicated += other.duplicated;
  delayed += other.delayed;
  delayed_data += other.delayed_data;
  falsified += other.falsified;
  swapped += other.swapped;
}

double Link::Roll(Dice dice) const {
  // Chained, so that seed, link, packet and kind of fault all change the result.
  std::uint64_t bits = Mix(options_.seed);
  bits = Mix(bits ^ number_);
  bits = Mix(bits ^ counts_.packets);
  bits = Mix(bits ^ static_cast<std::uint64_t>(dice));
  // The upper 53 bits fill the mantissa of a double exactly: uniform in [0, 1).
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

std::int64_t Link::DueUs(std::span<const std::uint8_t> packet, std::int64_t now_us) {
  if (Hits(Dice::kDelay, options_.delay)) {
    ++counts_.delayed;
    if (IsTamperable(packet)) ++counts_.delayed_data;
    return now_us + std::llround(options_.delay_ms * 1e3);
  }
  return now_us + std::llround(options_.jitter_ms * 1e3 * Roll(Dice::kJitter));
}

void Link::Push(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  if (InBlackHole(options_.black_holes, static_cast<double>(now_us - start_us_) * 1e-6)) {
    ++counts_.swallowed;
  } else if (Hits(Dice::kLoss, options_.loss)) {
    ++counts_.lost;
    if (IsTamperable(bytes)) ++counts_.lost_data;
  } else {
    Take(bytes, now_us);
  }
  // Last: Roll() uses the count as the number of the present packet.
  ++counts_.packets;
}

void Link::Take(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  // Without tampering, datagrams pass as they are, also those that are not of this protocol.
  if (!options_.tampers()) return Handle(bytes, now_us);
  (void)gathered_.Expire(now_us);
  std::span<const std::uint8_t> message;
  switch (gathered_.Push({}, bytes, now_us, message)) {
    case protocol::FragmentStatus::kPending: return;
    case protocol::FragmentStatus::kWhole:
    case protocol::FragmentStatus::kComplete: return Handle(message, now_us);
    default: return Handle(bytes, now_us);  // malformed: the receiver decides
  }
}

void Link::Handle(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  std::vector<std::uint8_t> packet(bytes.begin(), bytes.end());
  if (Hits(Dice::kFalsify, options_.falsify) && Falsify(&packet, Roll(Dice::kAmount)))
    ++counts_.falsified;
  const std::int64_t due_us = DueUs(packet, now_us);
  if (Hits(Dice::kDuplicate, options_.duplicate)) {
    ++counts_.duplicated;
    // The copy is queued at once and takes no part in the faults below.
    waiting_.emplace(due_us, packet);
  }
  Send(std::move(packet), now_us, due_us);
}

// Queues the packet, or holds it back for the next packet.
void Link::Send(std::vector<std::uint8_t> packet, std::int64_t now_us, std::int64_t due_us) {
  // A packet waits for a partner of its kind. The first that fits swaps contents with it, and both
  // leave.
  if (to_swap_ != waiting_.end() && SwapContents(&to_swap_->second, &packet)) {
    counts_.swapped += 2;
    Release(&to_swap_, due_us);
  } else if (to_swap_ == waiting_.end() && Hits(Dice::kSwap, options_.swap) &&
             IsTamperable(packet)) {
    // Held packets wait in the same queue, so that they leave at the latest when the stream pauses.
    to_swap_ = waiting_.emplace(now_us + kLongestHoldUs, std::move(packet));
    return;
  }
  if (to_reorder_ == waiting_.end() && Hits(Dice::kReorder, options_.reorder)) {
    to_reorder_ = waiting_.emplace(now_us + kLongestHoldUs, std::move(packet));
    return;
  }
  waiting_.emplace(due_us, std::move(packet));
  if (to_reorder_ != waiting_.end()) {
    ++counts_.reordered;
    Release(&to_reorder_, due_us);
  }
}

void Link::Release(Waiting::iterator* held, std::int64_t due_us) {
  // Changes the due time without copying the packet. Iterators to other packets stay valid.
  auto node = waiting_.extract(std::exchange(*held, waiting_.end()));
  node.key() = due_us;
  waiting_.insert(std::move(node));
}

bool Link::Pop(std::int64_t now_us, std::vector<std::uint8_t>* packet) {
  if (num_left_ == num_datagrams_ && !TakeFirst(now_us)) return false;
  // A message that was reassembled for tampering may need several datagrams again.
  if (num_datagrams_ == 1) {
    packet->swap(leaving_);
  } else {
    packet->resize(protocol::kMaxDatagramBytes);
    packet->resize(protocol::WriteDatagram(leaving_, message_id_, num_left_, *packet));
  }
  ++num_left_;
  return true;
}

bool Link::TakeFirst(std::int64_t now_us) {
  const auto first = waiting_.begin();
  if (first == waiting_.end() || first->first > now_us) return false;
  // The packet has waited too long for a partner and leaves as it is.
  if (first == to_swap_) to_swap_ = waiting_.end();
  if (first == to_reorder_) to_reorder_ = waiting_.end();
  leaving_ = std::move(first->second);
  waiting_.erase(first);
  num_datagrams_ = options_.tampers() ? NumDatagrams(leaving_) : 1;
  num_left_ = 0;
  ++message_id_;
  return true;
}

}  // namespace furrow::chaos
