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
  const int fields = std::sscanf(text.c_str(), "%lf:%lf%n:%lf%n", &hole.start, &hole.length, &used,
                                 &hole.every, &used);
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
  swallowed += other.swallowed;
  reordered += other.reordered;
  duplicated += other.duplicated;
  delayed += other.delayed;
  falsified += other.falsified;
  swapped += other.swapped;
}

double Link::Roll(Dice dice) const {
  std::uint64_t bits = Mix(options_.seed);
  bits = Mix(bits ^ number_);
  bits = Mix(bits ^ counts_.packets);
  bits = Mix(bits ^ static_cast<std::uint64_t>(dice));
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

std::int64_t Link::DueUs(std::int64_t now_us) {
  if (Hits(Dice::kDelay, options_.delay)) {
    ++counts_.delayed;
    return now_us + std::llround(options_.delay_ms * 1e3);
  }
  return now_us + std::llround(options_.jitter_ms * 1e3 * Roll(Dice::kJitter));
}

void Link::Push(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  if (InBlackHole(options_.black_holes, static_cast<double>(now_us - start_us_) * 1e-6)) {
    ++counts_.swallowed;
  } else if (Hits(Dice::kLoss, options_.loss)) {
    ++counts_.lost;
  } else {
    Take(bytes, now_us);
  }
  ++counts_.packets;
}

void Link::Take(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  if (!options_.tampers()) return Handle(bytes, now_us);
  (void)gathered_.Expire(now_us);
  std::span<const std::uint8_t> message;
  switch (gathered_.Push(0, bytes, now_us, message)) {
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
  const std::int64_t due_us = DueUs(now_us);
  if (Hits(Dice::kDuplicate, options_.duplicate)) {
    ++counts_.duplicated;
    waiting_.emplace(due_us, packet);
  }
  Send(std::move(packet), now_us, due_us);
}

// Queues the packet, or holds it back for the next packet.
void Link::Send(std::vector<std::uint8_t> packet, std::int64_t now_us, std::int64_t due_us) {
  if (to_swap_ != waiting_.end() && SwapContents(&to_swap_->second, &packet)) {
    counts_.swapped += 2;
    Release(&to_swap_, due_us);
  } else if (to_swap_ == waiting_.end() && Hits(Dice::kSwap, options_.swap) &&
             IsTamperable(packet)) {
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
  auto node = waiting_.extract(std::exchange(*held, waiting_.end()));
  node.key() = due_us;
  waiting_.insert(std::move(node));
}

bool Link::Pop(std::int64_t now_us, std::vector<std::uint8_t>* packet) {
  if (num_left_ == num_datagrams_ && !TakeFirst(now_us)) return false;
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
