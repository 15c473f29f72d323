// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_rules.h"

#include <algorithm>

namespace furrow::wrinkle {

ShapeRules::ShapeRules(std::span<const ShapeRule> rules, std::span<const ShapeRule::Group> groups)
    : is_binary_(groups.size(), false) {
  constexpr std::array<ShapeRule::Limits, ShapeRule::kNumGroups> kLimitsNothing{};
  for (const ShapeRule& rule : rules) {
    if (rule.shape >= groups.size()) continue;
    ShapeRule kept = rule;
    const ShapeRule::Group own = groups[rule.shape];
    if (own < kept.limits.size()) kept.limits[own] = ShapeRule::Limits::kNothing;
    if (!kept.is_binary && kept.limits == kLimitsNothing) continue;
    rules_.push_back(kept);
    is_binary_[rule.shape] = rule.is_binary;
  }
  for (std::uint32_t shape = 0; shape < groups.size(); ++shape) {
    if (groups[shape] < members_.size()) members_[groups[shape]].push_back(shape);
  }
}

void ShapeRules::Apply(std::span<float> weights) const {
  if (weights.size() < is_binary_.size()) return;
  std::array<float, ShapeRule::kNumGroups> left{};
  left.fill(1.0f);
  // All limits are measured before any weight is limited, so the order of the rules is free.
  for (const ShapeRule& rule : rules_) {
    float& weight = weights[rule.shape];
    if (rule.is_binary) weight = weight > 0.5f ? 1.0f : 0.0f;
    const float present = std::clamp(weight, 0.0f, 1.0f);
    for (std::size_t group = 0; group < left.size(); ++group) {
      switch (rule.limits[group]) {
        case ShapeRule::Limits::kBlock: left[group] -= present > 0.0f ? 1.0f : 0.0f; break;
        case ShapeRule::Limits::kBlend: left[group] -= present; break;
        case ShapeRule::Limits::kNothing: break;
      }
    }
  }
  for (std::size_t group = 0; group < left.size(); ++group) {
    if (left[group] == 1.0f) continue;
    const float factor = std::max(left[group], 0.0f);
    for (const std::uint32_t shape : members_[group]) {
      weights[shape] *= is_binary_[shape] ? 0.0f : factor;
    }
  }
}

}  // namespace furrow::wrinkle
