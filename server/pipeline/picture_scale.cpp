// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_scale.h"

#include <algorithm>
#include <iterator>

#include "render/request/frame_request.h"

namespace furrow::server {
namespace {

constexpr double kTooSlow = 1.05;  // times the target
constexpr double kSpare = 0.75;    // times the target; a step up costs at most two fifths
constexpr double kBusy = 0.7;      // of the time; with more idle time, the viewer limits the rate
constexpr double kIdle = 0.5;      // of the time; remains at kBusy after a step up
// Times the mean work of the streams: with less, others make it slow, and with half of it, a larger
// size costs them little.
constexpr double kItsPart = 0.9;
constexpr double kLittle = 0.5;
constexpr double kStepsPerExcess = 6.0;
constexpr int kMostStepsAtOnce = 4;
constexpr int kSoon = 2 * PictureScale::kQuick;  // pictures

// Sizes between the first two would cost more than they save: completing a picture takes about a
// fifth of the time of a full one.
constexpr float kScales[] = {1.0f, 0.75f, 0.6875f, 0.625f, 0.5625f, render::kMinScale};
constexpr int kLastStep = static_cast<int>(std::size(kScales)) - 1;

}  // namespace

float PictureScale::scale() const { return kScales[step_]; }

void PictureScale::Observe(const Interval& interval) {
  if (interval.passed - interval.busy > kPause) return;
  if (since_raised_ >= 0 && ++since_raised_ > kSoon) {
    since_raised_ = -1;
    patience_ = 1;
  }
  const double target = ToSeconds(kTarget);
  const double busy = ToSeconds(interval.busy);
  const double passed = ToSeconds(interval.passed);
  // The work if all streams took as long as this one.
  const double alike = interval.num_streams * ToSeconds(interval.own);
  const bool slow = busy > kTooSlow * target && busy > kBusy * passed && alike >= kItsPart * busy;
  const bool quick = busy < std::max(kSpare * target, kIdle * passed) || alike < kLittle * busy;
  num_slow_ = slow ? num_slow_ + 1 : 0;
  num_quick_ = quick ? num_quick_ + 1 : 0;
  if (num_slow_ >= kSlow) Lower(interval.busy);
  if (num_quick_ >= patience_ * kQuick) Raise();
}

// By more steps the slower it is, so that a stream is smooth within a second.
void PictureScale::Lower(Time busy) {
  num_slow_ = 0;
  if (since_raised_ >= 0) patience_ = std::min(2 * patience_, kMostPatience);
  since_raised_ = -1;
  const double excess = ToSeconds(busy) / ToSeconds(kTarget) - 1.0;
  const int steps = std::clamp(1 + static_cast<int>(kStepsPerExcess * excess), 1, kMostStepsAtOnce);
  step_ = std::min(step_ + steps, kLastStep);
}

void PictureScale::Raise() {
  num_quick_ = 0;
  if (step_ == 0) return;
  --step_;
  since_raised_ = 0;
}

}  // namespace furrow::server
