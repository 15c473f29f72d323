// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/skeleton/joint_chain.h"

namespace furrow::wrinkle {

// The geometry that drivers saw in one pose, for `furrow rig explain`. Drivers with missing joints
// are left out.
struct DriverExplanation {
  // A value of a pose driver (4.1). Lengths are in the skeleton's units, measured in the anchor's
  // space. Those of blend shapes alone are lengths of lists of coefficients.
  struct PoseValue {
    std::string driver_value;
    float displacement = 0.0f;   // |d|: rest to reference pose
    float moved = 0.0f;          // |x|: rest to this pose
    float numerator = 0.0f;      // dot(x, d)
    float along = 0.0f;          // numerator / |d|^2, or the nnls weight; not clamped
    float perpendicular = 0.0f;  // what the projection, or the whole fit, leaves over
    float falloff = 1.0f;        // factor for `perpendicular`; 1 if `along` is not above 0
    float result = 0.0f;         // the driver value
  };
  // An angle that a hinge, ball or twist driver measures, in degrees.
  struct Angle {
    std::string driver;
    // "flexion", "bend", "direction" (from forward towards the subject's right) or "twist".
    std::string what;
    float degrees = 0.0f;
  };
  // The patch of a strain driver.
  struct Strain {
    std::string driver;
    float smallest = 1.0f;  // principal stretches, area mean of the patch
    float largest = 1.0f;
    // Direction of the strongest compression: from the driver's direction to the left as seen from
    // outside, (-90, 90].
    float degrees = 0.0f;
  };
  // A blend shape that a driver reads, with the stream's coefficient: all of a blend-shape or pose
  // driver, and of a strain driver those that move its patch now.
  struct Shape {
    std::string driver;
    std::string blend_shape;  // as the rig spells it
    float coefficient = 0.0f;
  };
  std::vector<PoseValue> pose_values;
  std::vector<Angle> angles;
  std::vector<Strain> strains;
  std::vector<Shape> shapes;

  // The shapes that a driver reads, strongest first. They point into this object.
  [[nodiscard]] std::vector<const Shape*> ShapesOf(std::string_view driver) const {
    std::vector<const Shape*> read;
    for (const Shape& shape : shapes) {
      if (shape.driver == driver) read.push_back(&shape);
    }
    std::ranges::stable_sort(read, std::greater(),
                             [](const Shape* shape) { return std::abs(shape->coefficient); });
    return read;
  }
};

// One solved pose of a binding, to be explained.
struct SolvedPose {
  std::span<const Transform> local;
  std::span<const float> blend_shapes;  // the stream's coefficients
  const JointChains& chains;
  std::span<const float> driver_values;             // as the solver computed them
  std::span<const std::string> driver_value_names;  // "<driver>.<value>"

  // The driver with this first value.
  [[nodiscard]] std::string DriverName(int first_value) const {
    const std::string& name = driver_value_names[static_cast<std::size_t>(first_value)];
    return name.substr(0, name.rfind('.'));
  }
  // The coefficient at this place; 0 past the end.
  [[nodiscard]] float Coefficient(int place) const {
    const auto index = static_cast<std::size_t>(place);
    return index < blend_shapes.size() ? blend_shapes[index] : 0.0f;
  }
};

}  // namespace furrow::wrinkle
