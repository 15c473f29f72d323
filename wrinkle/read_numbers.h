// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace furrow::wrinkle {

struct BindingData;

// Some of the numbers of a pose, its joints' Transforms taken as one list of floats.
struct NumberRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

// The numbers that no driver reads where drivers are evaluated side by side (batch_drivers-inl.h).
// Those it reads are checked for NaN and infinity on the way; these must be looked at apart. Close
// ranges are one: a few numbers are looked at twice. Private to wrinkle/.
[[nodiscard]] std::vector<NumberRange> UnreadNumbers(const BindingData& data);

}  // namespace furrow::wrinkle
