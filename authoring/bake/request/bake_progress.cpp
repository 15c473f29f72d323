// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/request/bake_progress.h"

#include <algorithm>

namespace furrow::authoring {
namespace {

constexpr std::size_t kStepsPerReport = 2048;

}  // namespace

void BakeProgress::BeginPart(float from, float to) {
  from_ = from;
  to_ = to;
}

bool BakeProgress::Report(float done) {
  last_ = std::max(last_, done >= 1.0f ? to_ : from_ + (to_ - from_) * done);
  return CallBack();
}

bool BakeProgress::ReportStep(std::size_t index, std::size_t count) {
  if (index % kStepsPerReport != 0) return !cancelled_;
  return Report(static_cast<float>(index) / static_cast<float>(std::max<std::size_t>(count, 1)));
}

bool BakeProgress::RepeatReport(std::size_t index) {
  if (index == 0 || index % kStepsPerReport != 0) return !cancelled_;
  return CallBack();
}

bool BakeProgress::CallBack() {
  if (!cancelled_ && callback_ && !callback_(last_)) cancelled_ = true;
  return !cancelled_;
}

}  // namespace furrow::authoring
