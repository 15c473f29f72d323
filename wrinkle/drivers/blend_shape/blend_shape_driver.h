// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/drivers/bind_context.h"

namespace furrow::wrinkle {

// A tracker's coefficient as a driver value: clamp((c - neutral) / (full - neutral), 0, 1). `full`
// may lie below `neutral`, not on it.
[[nodiscard]] float BlendShapeValue(float coefficient, float neutral, float full);

// All blend-shape drivers of a binding. Private to wrinkle/.
class BlendShapeDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int blend_shape = 0;
    float neutral = 0.0f;
    float full = 1.0f;
  };

  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  // Coefficients past the end of `blend_shapes` count as 0.
  void Evaluate(std::span<const float> blend_shapes, std::span<float> driver_values) const;
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

}  // namespace furrow::wrinkle
