// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// A rig on a skeleton, and its values by name.
class BoundRig {
 public:
  BoundRig(const Rig& rig, const Skeleton& skeleton,
           const std::vector<std::string>& blend_shapes = {"jawOpen"}) {
    Result<RigBinding> bound = RigBinding::Create(rig, skeleton, blend_shapes);
    EXPECT_TRUE(bound.ok()) << bound.status().ToString();
    binding_ = std::make_shared<const RigBinding>(std::move(bound).value());
    values_.resize(binding_->driver_value_names().size());
    weights_.resize(binding_->weight_names().size());
  }

  // Driver values and wrinkle weights of `pose`, unfiltered.
  void Solve(const LocalPose& pose) {
    SubjectSolver solver(binding_, false);
    EXPECT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
    std::ranges::copy(solver.driver_values(), values_.begin());
    std::ranges::copy(solver.wrinkle_weights(), weights_.begin());
  }

  [[nodiscard]] float Value(const std::string& name) const {
    return At(binding_->driver_value_names(), values_, name);
  }
  [[nodiscard]] float Weight(const std::string& name) const {
    return At(binding_->weight_names(), weights_, name);
  }
  [[nodiscard]] float ValueAt(const LocalPose& pose, const std::string& name) {
    Solve(pose);
    return Value(name);
  }

  [[nodiscard]] const std::shared_ptr<const RigBinding>& binding() const { return binding_; }
  [[nodiscard]] const Skeleton& skeleton() const { return binding_->skeleton(); }
  [[nodiscard]] std::vector<float>& values() { return values_; }
  [[nodiscard]] std::vector<float>& weights() { return weights_; }

 private:
  static float At(std::span<const std::string> names, const std::vector<float>& numbers,
                  const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return numbers[i];
    }
    ADD_FAILURE() << "no '" << name << "'";
    return -1.0f;
  }

  std::shared_ptr<const RigBinding> binding_;
  std::vector<float> values_;
  std::vector<float> weights_;
};

}  // namespace furrow::wrinkle
