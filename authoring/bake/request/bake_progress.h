// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "base/status.h"

namespace furrow::authoring {

// Reports the progress of a bake and passes on a request to cancel it. Not thread-safe.
//
// Every method that returns bool returns false once the bake is cancelled.
class BakeProgress {
 public:
  // `callback` (optional) receives the completed fraction, [0, 1], which never decreases. It
  // cancels the bake by returning false.
  explicit BakeProgress(std::function<bool(float)> callback) : callback_(std::move(callback)) {}

  // Starts the part of the work from `from` to `to`, both fractions of the whole, [0, 1].
  void BeginPart(float from, float to);
  // Reports `done`, the completed fraction of the current part, [0, 1].
  bool Report(float done);
  // Reports step `index` of `count` in the current part. Calls the callback every 2,048 steps.
  bool ReportStep(std::size_t index, std::size_t count);
  // Repeats the last report every 2,048 steps, for loops that make no measurable progress.
  bool RepeatReport(std::size_t index);

  [[nodiscard]] bool cancelled() const { return cancelled_; }
  // kUnavailable: the status of a function that was cancelled.
  [[nodiscard]] static Status CancelledStatus() { return {StatusCode::kUnavailable, "cancelled"}; }

 private:
  bool CallBack();

  std::function<bool(float)> callback_;
  float from_ = 0.0f;
  float to_ = 1.0f;
  float last_ = 0.0f;  // the highest fraction that was reported
  bool cancelled_ = false;
};

}  // namespace furrow::authoring
