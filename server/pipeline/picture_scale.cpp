// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_scale.h"

#include <algorithm>

#include "render/request/frame_request.h"

namespace furrow::server {
namespace {

constexpr double kTooSlow = 1.05;  // times the target
constexpr double kSpare = 0.75;    // a step up costs at most a sixth
constexpr double kBusy = 0.9;      // with more idle time, somebody else limits the rate
constexpr int kMostStepsAtOnce = 4;
constexpr int kSoon = 2 * PictureScale::kQuick;  // pictures

}  // namespace

float PictureScale::scale() const {
  return 1.0f - (1.0f - render::kMinScale) * static_cast<float>(step_) / kSteps;
}

void PictureScale::Observe(Time busy, Time passed) {
  if (passed > kPause) return;
  if (since_raised_ >= 0 && ++since_raised_ > kSoon) {
    since_raised_ = -1;
    patience_ = 1;
  }
  const double work = ToSeconds(busy);
  const bool slow = work > kTooSlow * ToSeconds(kTarget) && work > kBusy * ToSeconds(passed);
  const bool quick = work < kSpare * ToSeconds(std::max(kTarget, passed));
  num_slow_ = slow ? num_slow_ + 1 : 0;
  num_quick_ = quick ? num_quick_ + 1 : 0;
  if (num_slow_ >= kSlow) Lower(busy);
  if (num_quick_ >= patience_ * kQuick) Raise();
}

// By more steps the slower it is, so that a stream is smooth within a second.
void PictureScale::Lower(Time busy) {
  num_slow_ = 0;
  if (since_raised_ >= 0) patience_ = std::min(2 * patience_, kMostPatience);
  since_raised_ = -1;
  const double excess = ToSeconds(busy) / ToSeconds(kTarget) - 1.0;
  const int steps = std::clamp(1 + static_cast<int>(kSteps * excess), 1, kMostStepsAtOnce);
  step_ = std::min(step_ + steps, kSteps);
}

void PictureScale::Raise() {
  num_quick_ = 0;
  if (step_ == 0) return;
  --step_;
  since_raised_ = 0;
}

}  // namespace furrow::server
