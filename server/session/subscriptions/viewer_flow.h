// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// Flow control of one viewer that acknowledges its pictures (STANDARD.md section 9). At most two
// pictures are unacknowledged at a time, the newest pose wins, and three quality tiers adapt to the
// viewer's speed.
//
// Each picture passes through Request(), then Send(), Fail() or Withdraw(), then Acknowledge() or
// TakeBack().
// Only one picture is requested from the renderer at a time. The caller supplies the time.
class ViewerFlow {
 public:
  // Unacknowledged pictures at a time (STANDARD.md section 9).
  static constexpr std::uint32_t kMaxUnderWay = 2;
  static constexpr int kNumTiers = 3;
  static constexpr Time kRetry = FromSeconds(0.25);  // delay after a failed picture
  // A picture that has not come for this long is requested again.
  static constexpr Time kGiveUp = FromSeconds(60.0);

  // True if the viewer may receive another picture and none is requested, or not for kGiveUp.
  [[nodiscard]] bool CanRequest(Time now) const;
  // True between Request() and Send(), Fail() or Withdraw().
  [[nodiscard]] bool is_pending() const { return pending_; }
  // A picture is requested from the renderer. `still`: the refined picture of a pose at rest.
  void Request(bool still, Time now);
  // The requested picture is ready. Returns its number; the first is 1.
  [[nodiscard]] std::uint32_t Send();
  // The requested picture could not be rendered.
  void Fail();
  // The picture of the last Send() was dropped on its way to the viewer, which never learns its
  // number. As after Fail(), the next one is requested after kRetry.
  void TakeBack();
  // The request was cancelled before its picture was encoded.
  void Withdraw();
  // The viewer has shown this picture and all before it. False: the picture was never sent.
  bool Acknowledge(std::uint32_t number);

  // Call once for each pose that the viewer could be shown, before Request(). Updates the tier.
  void CountDue(Time now);

  // True if the newest request is a still made at or after `since`, when the view last changed.
  [[nodiscard]] bool HasStill(Time since) const { return has_still_ && requested_at_ >= since; }
  // The quality tier: 0 is best, kNumTiers - 1 is worst.
  [[nodiscard]] int tier() const { return tier_; }
  // Number of sent pictures that are not acknowledged.
  [[nodiscard]] std::uint32_t under_way() const { return sent_ - acknowledged_; }
  // Poses that were skipped because two pictures were unacknowledged.
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  void EndWindow(Time now);

  std::uint32_t sent_ = 0;
  std::uint32_t acknowledged_ = 0;
  std::uint32_t dropped_ = 0;
  bool pending_ = false;
  bool has_still_ = false;
  bool failed_ = false;
  Time requested_at_{0};

  // The tier is decided once per window of a second.
  int tier_ = 0;
  bool has_window_ = false;
  bool has_risen_ = false;  // since the tier last fell
  Time window_{0};          // when the window began
  Time good_since_{0};      // no pose has been skipped since
  Time patience_ = FromSeconds(4.0);
  int due_ = 0;     // poses in this window
  int missed_ = 0;  // of them, skipped
};

}  // namespace furrow::server
