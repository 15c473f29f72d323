// SPDX-License-Identifier: Apache-2.0
#include "handover_receiver.h"

#include <algorithm>
#include <utility>

namespace furrow::server::testing {
namespace {

constexpr std::int64_t kBreakMs = 200;  // between frames; a longer one interrupts the service
constexpr std::int64_t kCalmMs = 400;   // of service, which ends a schedule
constexpr std::int64_t kStartMs = 50;   // after the beginning, before which nothing has settled

}  // namespace

void HandoverReceiver::Fail(std::string fault, std::int64_t now) {
  if (!outcome_.fault.empty()) return;
  outcome_.fault = std::move(fault) + " at " + std::to_string(now) + " ms";
}

void HandoverReceiver::NoteServing(const Owner& owner, std::uint64_t epoch, std::int64_t now) {
  const auto [known, added] = owners_.emplace(epoch, owner);
  if (!added && known->second != owner) {
    Fail("two nodes served epoch " + std::to_string(epoch), now);
  }
}

void HandoverReceiver::OnFrame(std::uint64_t epoch, bool warm, std::uint32_t sequence,
                               std::int64_t now) {
  const std::pair frame(epoch, sequence);
  if (frame <= newest_) {
    if (epoch < newest_.first) ++outcome_.fenced;
    return;
  }
  if (warm && sequence <= newest_.second) {
    Fail("pose " + std::to_string(sequence) + " came after " + std::to_string(newest_.second), now);
  }
  newest_ = frame;
  ++outcome_.frames;
  NoteGap(now);
  if (now - last_used_ > kBreakMs) calm_since_ = now;
  last_used_ = now;
}

void HandoverReceiver::NoteGap(std::int64_t now) {
  if (now < begin_) return;
  outcome_.gap_ms = std::max(outcome_.gap_ms, now - std::max(last_used_, begin_));
  if (now > last_fault_) {
    outcome_.settled_ms = std::max(outcome_.settled_ms, now - std::max(last_used_, last_fault_));
  }
}

bool HandoverReceiver::HasSettled(std::int64_t now) const {
  if (now < begin_ + kStartMs || now < last_fault_) return false;
  return now - last_used_ < kBreakMs && now - std::max(calm_since_, last_fault_) >= kCalmMs;
}

}  // namespace furrow::server::testing
