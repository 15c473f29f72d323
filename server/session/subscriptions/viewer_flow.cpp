// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/viewer_flow.h"

#include <algorithm>

namespace furrow::server {
namespace {

constexpr Time kWindow = FromSeconds(1.0);
constexpr Time kLongestPatience = FromSeconds(64.0);
constexpr int kFewestDue = 4;  // of a window that says anything

}  // namespace

bool ViewerFlow::MayAsk(Time now) const {
  if (asking_ || under_way() >= kMaxUnderWay) return false;
  return !failed_ || now - asked_at_ >= kRetry;
}

void ViewerFlow::Ask(bool still, Time now) {
  asking_ = true;
  has_still_ = still;
  failed_ = false;
  asked_at_ = now;
}

std::uint32_t ViewerFlow::Send() {
  asking_ = false;
  return ++sent_;
}

void ViewerFlow::Fail() {
  Withdraw();
  failed_ = true;
}

void ViewerFlow::Withdraw() {
  asking_ = false;
  has_still_ = false;
}

bool ViewerFlow::Acknowledge(std::uint32_t number) {
  // By subtraction: numbers wrap.
  if (number - acknowledged_ <= under_way()) {
    acknowledged_ = number;
    return true;
  }
  return static_cast<std::int32_t>(number - sent_) < 0;  // an old one, again
}

void ViewerFlow::CountDue(Time now) {
  if (!has_window_) {
    has_window_ = true;
    window_ = good_since_ = now;
  }
  if (now - window_ >= kWindow) EndWindow(now);
  ++due_;
  if (under_way() < kMaxUnderWay) return;
  ++missed_;
  ++dropped_;
}

// Down at once, up slowly, and more slowly each time that going up proved wrong: no to and fro.
void ViewerFlow::EndWindow(Time now) {
  if (missed_ > 0) good_since_ = now;
  if (due_ >= kFewestDue && missed_ * 4 >= due_ && tier_ < kNumTiers - 1) {
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
