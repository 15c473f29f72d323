// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/video_rate.h"

#include <algorithm>

namespace furrow::server {
namespace {

constexpr Time kQuarter = FromSeconds(15.0);
// Longer ways than this are first taken for slow ones, because at the beginning all trips may be
// long for want of bits per second.
constexpr double kUsualTrip = 0.1;
constexpr int kLateOnes = 3;
constexpr Time kVeryLate = FromSeconds(0.3);
// The share of what the network carries. The rest keeps its queues short.
constexpr double kShare = 0.8;
// A lowering helped if the pictures are late by less than this share of before.
constexpr double kHelped = 0.5;
constexpr int kTrialPictures = 3;
// Per second. A lowering after a long time may be a mistake, such as after a pause of the viewer's
// computer, so the rate returns faster until near what it was.
constexpr double kRise = 0.08;
constexpr double kReturn = 0.5;
constexpr double kNear = 0.6;
constexpr Time kLongTime = FromSeconds(10.0);
// The rate rises only while the video uses this much of it. Otherwise nothing shows that the
// network carries more.
constexpr double kUsed = 0.5;
constexpr Time kLongestStep = FromSeconds(0.25);
constexpr double kMeanStep = 0.1;
constexpr double kMinInterval = 1.0 / 60.0;
constexpr double kMaxInterval = 1.0 / 10.0;

void MoveMean(double value, double* mean) { *mean += kMeanStep * (value - *mean); }

}  // namespace

void VideoRate::Sent(std::uint32_t number, std::size_t bytes, Time now) {
  // Flow control allows two; a viewer that acknowledges nothing costs no memory.
  if (num_under_way_ == kMaxUnderWay) {
    std::move(under_way_.begin() + 1, under_way_.end(), under_way_.begin());
    --num_under_way_;
  }
  const double bits = 8.0 * static_cast<double>(bytes);
  under_way_[num_under_way_++] = {.number = number, .bits = bits, .sent = now};
  if (has_sent_) {
    // A slow network spaces the pictures, too. Larger pictures would make it slower.
    if (late_ == 0 && !is_on_trial_ && excess_s_ < normal_s_ + ToSeconds(kPatience) / 2.0) {
      MoveMean(std::clamp(ToSeconds(now - last_sent_), kMinInterval, kMaxInterval), &interval_s_);
    }
    MoveMean(bits, &picture_bits_);
  } else {
    has_sent_ = true;
    picture_bits_ = bits;
    decides_from_ = number;
  }
  last_number_ = number;
  last_sent_ = now;
}

void VideoRate::Acknowledged(std::uint32_t number, Time held, Time now) {
  const auto begin = under_way_.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(num_under_way_);
  const auto found = std::find_if(
      begin, end, [number](const Picture& picture) { return picture.number == number; });
  if (found == end) return;
  const Picture picture = *found;
  num_under_way_ = static_cast<std::size_t>(std::move(found + 1, end, begin) - begin);
  const Time trip = now - picture.sent;
  const double trip_s = ToSeconds(trip - std::clamp(held, Time{0}, trip));
  Learn(trip_s, now);
  Judge(picture, trip_s - std::min({shortest_s_, former_shortest_s_, kUsualTrip}), now);
  Raise(now);
  has_acknowledgement_ = true;
  last_acknowledged_ = now;
}

void VideoRate::Learn(double trip_s, Time now) {
  if (!has_trip_) {
    has_trip_ = true;
    shortest_s_ = former_shortest_s_ = trip_s;
    quarter_ = now;
  } else if (now - quarter_ >= kQuarter) {
    // The machine may be less busy by now, but the way is as long as it is.
    normal_s_ = std::min(normal_s_, std::max(normal_s_ / 2.0, shortest_s_ - kUsualTrip));
    former_shortest_s_ = shortest_s_;
    shortest_s_ = trip_s;
    quarter_ = now;
  }
  shortest_s_ = std::min(shortest_s_, trip_s);
}

void VideoRate::Judge(const Picture& picture, double excess_s, Time now) {
  // Unsigned subtraction, because numbers wrap around.
  if (static_cast<std::int32_t>(picture.number - decides_from_) < 0) return;
  excess_s_ = excess_s;
  if (is_on_trial_) {
    trial_excess_s_ += excess_s;
    if (++num_trial_ == kTrialPictures) JudgeLowering();
  }
  if (excess_s <= ToSeconds(kPatience) + normal_s_) {
    late_ = 0;
    return;
  }
  if (late_++ == 0) {
    late_since_ = has_acknowledgement_ ? std::max(last_acknowledged_, picture.sent) : picture.sent;
    late_bits_ = late_excess_s_ = 0.0;
  }
  late_bits_ += picture.bits;
  late_excess_s_ += excess_s;
  const bool is_enough = late_ >= kLateOnes || (late_ > 1 && now - late_since_ >= kVeryLate);
  if (!is_enough) return;
  Lower(late_bits_ / std::max(ToSeconds(now - late_since_), 1e-3) / 1e3, now);
}

void VideoRate::Lower(double carried_kbps, Time now) {
  const double excess_s = late_excess_s_ / late_;
  late_ = 0;
  const double wanted = std::max(kShare * carried_kbps, double{kMinKbps});
  if (wanted >= kbps_) return;
  // The trial of a lowering in steps asks whether the first step was right.
  if (!is_on_trial_) {
    kbps_before_ = kbps_;
    excess_before_s_ = excess_s;
  }
  const bool is_first = !has_lowered_ || now - lowered_ >= kLongTime;
  returns_to_kbps_ = is_first ? kNear * kbps_before_ : 0.0;
  has_lowered_ = true;
  lowered_ = now;
  is_on_trial_ = true;
  trial_excess_s_ = 0.0;
  num_trial_ = 0;
  kbps_ = wanted;
  decides_from_ = last_number_ + 1;
}

// If the pictures are as late as before, the rate was not the reason.
void VideoRate::JudgeLowering() {
  is_on_trial_ = false;
  const double excess_s = trial_excess_s_ / kTrialPictures;
  if (excess_s < kHelped * excess_before_s_) return;
  normal_s_ = std::max(normal_s_, excess_s);
  kbps_ = kbps_before_;
}

void VideoRate::Raise(Time now) {
  if (!has_acknowledgement_ || late_ > 0 || is_on_trial_) return;
  if (SentKbps() < kUsed * kbps_) return;
  const double step_s = ToSeconds(std::clamp(now - last_acknowledged_, Time{0}, kLongestStep));
  const double rise = kbps_ < returns_to_kbps_ ? kReturn : kRise;
  kbps_ = std::min<double>(kMaxKbps, kbps_ * (1.0 + rise * step_s));
}

int VideoRate::PictureBits() const { return static_cast<int>(kbps_ * 1e3 * interval_s_); }

}  // namespace furrow::server
