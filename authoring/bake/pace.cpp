// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/pace.h"

#include <algorithm>

namespace furrow::character::bake {
namespace {

constexpr std::size_t kSteps = 2048;  // between two calls

}  // namespace

void Pace::Enter(float from, float to) {
  from_ = from;
  to_ = to;
}

bool Pace::Tell(float done) {
  last_ = std::max(last_, done >= 1.0f ? to_ : from_ + (to_ - from_) * done);
  if (!stopped_ && told_ && !told_(last_)) stopped_ = true;
  return !stopped_;
}

bool Pace::Ask(std::size_t index) {
  if (index > 0 && index % kSteps == 0 && !stopped_ && told_ && !told_(last_)) stopped_ = true;
  return !stopped_;
}

bool Pace::Step(std::size_t index, std::size_t count) {
  if (index % kSteps != 0) return !stopped_;
  return Tell(static_cast<float>(index) / static_cast<float>(std::max<std::size_t>(count, 1)));
}

}  // namespace furrow::character::bake
