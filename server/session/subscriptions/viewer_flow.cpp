// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/viewer_flow.h"

#include <algorithm>

namespace furrow::server {
namespace {

constexpr Time kWindow = FromSeconds(1.0);
constexpr Time kLongestPatience = FromSeconds(64.0);
constexpr int kMinDue = 4;  // poses; a window with fewer decides nothing

}  // namespace

bool ViewerFlow::CanRequest(Time now) const {
  if (under_way() >= kMaxUnderWay) return false;
  if (pending_) return now - requested_at_ >= kGiveUp;
  return !failed_ || now - requested_at_ >= kRetry;
}

void ViewerFlow::Request(bool still, Time now) {
  pending_ = true;
  has_still_ = still;
  failed_ = false;
  requested_at_ = now;
}

std::uint32_t ViewerFlow::Send() {
  pending_ = false;
  return ++sent_;
}

void ViewerFlow::Fail() {
  Withdraw();
  failed_ = true;
}

void ViewerFlow::TakeBack() {
  --sent_;
  Fail();
}

void ViewerFlow::Withdraw() {
  pending_ = false;
  has_still_ = false;
}

bool ViewerFlow::Acknowledge(std::uint32_t number) {
  // Unsigned subtraction, because numbers wrap around.
  if (number - acknowledged_ <= under_way()) {
    acknowledged_ = number;
    return true;
  }
  // Numbers ahead of `sent_` were never sent, which is an error of the viewer.
  return static_cast<std::int32_t>(number - sent_) < 0;  // a repeated acknowledgement
}

void ViewerFlow::CountDue(Time now) {
  if (!has_window_) {
    has_window_ = true;
    window_ = good_since_ = now;
  }
  if (now - window_ >= kWindow) EndWindow(now);
  // A pose counts as missed only if two pictures are unacknowledged: then the viewer or its network
  // is slow. A slow renderer does not justify lowering the quality.
  ++due_;
  if (under_way() < kMaxUnderWay) return;
  ++missed_;
  ++dropped_;
}

// Quality falls at once and rises slowly. Each rise that proves wrong doubles the wait before the
// next one, so that the tier does not oscillate.
void ViewerFlow::EndWindow(Time now) {
  if (missed_ > 0) good_since_ = now;
  if (due_ >= kMinDue && missed_ * 4 >= due_ && tier_ < kNumTiers - 1) {
    ++tier_;
    if (has_risen_) patience_ = std::min(2 * patience_, kLongestPatience);
    has_risen_ = false;
  } else if (tier_ > 0 && now - good_since_ >= patience_) {
    --tier_;
    has_risen_ = true;
    good_since_ = now;
  }
  window_ = now;
  due_ = missed_ = 0;
}

}  // namespace furrow::server
