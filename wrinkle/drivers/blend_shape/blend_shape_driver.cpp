// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/blend_shape/blend_shape_driver.h"

#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

float BlendShapeValue(float coefficient, float neutral, float full) {
  return Saturate((coefficient - neutral) / (full - neutral));
}

Status BlendShapeDriverSet::Bind(const Driver& driver, int first_value, BindContext* context) {
  const BlendShapeDriver& shape = driver.blend_shape;
  const Result<int> found = context->BlendShape("driver '" + driver.name + "'", shape.blend_shape);
  FURROW_RETURN_IF_ERROR(found);
  if (*found < 0) return {};
  entries_.push_back({.first_value = first_value,
                      .blend_shape = *found,
                      .neutral = shape.neutral,
                      .full = shape.full});
  return {};
}

void BlendShapeDriverSet::Evaluate(std::span<const float> blend_shapes,
                                   std::span<float> driver_values) const {
  for (const Entry& entry : entries_) {
    if (!Reaches(driver_values, entry.first_value)) break;
    const std::size_t index = static_cast<std::size_t>(entry.blend_shape);
    const float coefficient = index < blend_shapes.size() ? blend_shapes[index] : 0.0f;
    driver_values[entry.first_value] = BlendShapeValue(coefficient, entry.neutral, entry.full);
  }
}

}  // namespace furrow::wrinkle
