// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "server/core/time.h"

namespace furrow::server {

// Chooses the share of its width and height at which the pictures of a stream are drawn
// (render::FrameRequest::scale), so that the renderer keeps up with kTarget. It goes down after a
// few slow pictures, and up by one step after a second or more with time to spare. A step up that
// turns out too slow makes the next one wait longer. A stream with less than its part of the work
// never goes down, because its own size would not help.
class PictureScale {
 public:
  static constexpr Time kTarget = std::chrono::microseconds(1'000'000 / 24);
  // Pictures in a row that are too slow, and that would leave time for a larger size.
  static constexpr int kSlow = 3;
  static constexpr int kQuick = 24;
  static constexpr int kMostPatience = 16;  // times kQuick
  // A longer time without work between two pictures is a pause, which says nothing about speed.
  static constexpr Time kPause = std::chrono::seconds(1);

  // From one picture of the stream to the next.
  struct Interval {
    Time own{0};          // the renderer worked for the second picture
    Time busy{0};         // it worked altogether, for this stream and for others
    Time passed{0};       // of the clock
    int num_streams = 1;  // which had a picture in that time, including this one
  };
  void Observe(const Interval& interval);
  [[nodiscard]] float scale() const;

 private:
  void Lower(Time busy);
  void Raise();

  int step_ = 0;  // 0: the full size; the next is three quarters of it
  int num_slow_ = 0;
  int num_quick_ = 0;
  int patience_ = 1;       // times kQuick
  int since_raised_ = -1;  // pictures; -1: the size was not raised lately
};

}  // namespace furrow::server
