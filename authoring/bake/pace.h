// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "base/status.h"

namespace furrow::character::bake {

// Tells how far a bake is, and whether it should go on. One thread at a time.
class Pace {
 public:
  // `told` (may be empty) is called with what is done, [0, 1], never less than before; false stops.
  explicit Pace(std::function<bool(float)> told) : told_(std::move(told)) {}

  // What follows is the part from `from` to `to` of the whole, [0, 1].
  void Enter(float from, float to);
  // `done` of the part, [0, 1]. False: to be stopped, now and ever after.
  bool Tell(float done);
  // The same without progress, of the part that was told last.
  bool Ask(std::size_t index);
  // Step `index` of `count` begins. Tells every now and then.
  bool Step(std::size_t index, std::size_t count);

  [[nodiscard]] bool stopped() const { return stopped_; }
  // kUnavailable, for what is left half done by a stop.
  [[nodiscard]] static Status Cancelled() { return {StatusCode::kUnavailable, "cancelled"}; }

 private:
  std::function<bool(float)> told_;
  float from_ = 0.0f;
  float to_ = 1.0f;
  float last_ = 0.0f;
  bool stopped_ = false;
};

}  // namespace furrow::character::bake
