// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// How fast one viewer that acknowledges its pictures may be shown them, and how well
// (STANDARD.md section 9): at most two under way, the newest wins, three tiers of quality.
//
// A picture goes through Ask() (of the renderer), then Send() or Fail(), then Acknowledge(). Only
// one is asked for at a time: what is drawn next is the newest pose then. No clock: `now` comes in.
class ViewerFlow {
 public:
  static constexpr std::uint32_t kMaxUnderWay = 2;
  static constexpr int kNumTiers = 3;
  static constexpr Time kRetry = FromSeconds(0.25);  // after a picture that could not be drawn

  [[nodiscard]] bool MayAsk(Time now) const;
  [[nodiscard]] bool asking() const { return asking_; }
  // `still`: the refined picture of a pose at rest; whatever is asked for later ends it.
  void Ask(bool still, Time now);
  // The picture that was asked for came: its number, from 1.
  [[nodiscard]] std::uint32_t Send();
  // ... or will not come.
  void Fail();
  // ... or is no longer asked for, and was not begun.
  void Withdraw();
  // The viewer has shown this one and all before. False: it was never sent.
  bool Acknowledge(std::uint32_t number);

  // A pose this viewer was due: once for each, before it is asked for. Decides the tier.
  void CountDue(Time now);

  // The still of what has been shown `since`; one asked for before, say of another view, is none.
  [[nodiscard]] bool HasStill(Time since) const { return has_still_ && asked_at_ >= since; }
  [[nodiscard]] int tier() const { return tier_; }
  [[nodiscard]] std::uint32_t under_way() const { return sent_ - acknowledged_; }
  // Poses that were due while two pictures were under way.
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  void EndWindow(Time now);

  std::uint32_t sent_ = 0;
  std::uint32_t acknowledged_ = 0;
  std::uint32_t dropped_ = 0;
  bool asking_ = false;
  bool has_still_ = false;
  bool failed_ = false;
  Time asked_at_{0};

  int tier_ = 0;
  bool has_window_ = false;
  bool has_risen_ = false;  // since the last fall
  Time window_{0};
  Time good_since_{0};
  Time patience_ = FromSeconds(4.0);
  int due_ = 0;
  int missed_ = 0;
};

}  // namespace furrow::server
