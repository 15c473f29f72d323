// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/drivers/bind_context.h"

namespace furrow::wrinkle {

// All twist drivers of a binding. Private to wrinkle/; the formula is in twist.h.
class TwistDriverSet {
 public:
  struct Entry {
    int first_value = 0;
    int first_joint = 0;  // into joints_
    int num_joints = 0;
    float inverse_full = 0.0f;  // 1 / radians
  };
  struct TwistJoint {
    int joint = kNoJoint;
    glm::quat rest_inverse{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 axis{0.0f};  // unit, joint's axes
  };

  [[nodiscard]] Status Bind(const Driver& driver, int first_value, BindContext* context);
  void Evaluate(std::span<const Transform> local, std::span<float> driver_values) const;

  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  [[nodiscard]] std::span<const TwistJoint> joints(const Entry& entry) const {
    return std::span(joints_).subspan(static_cast<std::size_t>(entry.first_joint),
                                      static_cast<std::size_t>(entry.num_joints));
  }
  [[nodiscard]] int num_entries() const { return static_cast<int>(entries_.size()); }
  [[nodiscard]] int first_value(int entry) const { return entries_[entry].first_value; }
  // Sum of the twists of the entry's joints away from rest, radians; positive: left.
  [[nodiscard]] float Angle(int entry, std::span<const Transform> local) const;

 private:
  std::vector<Entry> entries_;
  std::vector<TwistJoint> joints_;
};

}  // namespace furrow::wrinkle
