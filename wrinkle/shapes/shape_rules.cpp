// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_rules.h"

#include <algorithm>
#include <string_view>

#include "base/ascii.h"

namespace furrow::wrinkle {
namespace {

// VRM 1.0's presets and, after the bar, the same of VRM 0.x.
bool IsIn(ShapeRule::Group group, const std::string& name) {
  static constexpr std::string_view kBlinks[] = {"blink", "blinkLeft", "blinkRight", "blink_l",
                                                 "blink_r"};
  static constexpr std::string_view kLooks[] = {"lookUp", "lookDown", "lookLeft", "lookRight"};
  static constexpr std::string_view kVisemes[] = {"aa", "ih", "ou", "ee", "oh",
                                                  "a",  "i",  "u",  "e",  "o"};
  const auto is_one_of = [&](std::span<const std::string_view> names) {
    return std::ranges::any_of(names,
                               [&](std::string_view n) { return EqualsIgnoreCase(n, name); });
  };
  switch (group) {
    case ShapeRule::kBlinks: return is_one_of(kBlinks);
    case ShapeRule::kLooks: return is_one_of(kLooks);
    default: return is_one_of(kVisemes);
  }
}

}  // namespace

ShapeRules::ShapeRules(std::span<const ShapeRule> rules, std::span<const std::string> shapes)
    : rules_(rules.begin(), rules.end()), is_binary_(shapes.size(), false) {
  std::erase_if(rules_, [&](const ShapeRule& rule) { return rule.shape >= shapes.size(); });
  for (const ShapeRule& rule : rules_) is_binary_[rule.shape] = rule.is_binary;
  for (std::uint32_t shape = 0; shape < shapes.size(); ++shape) {
    for (std::size_t group = 0; group < members_.size(); ++group) {
      if (IsIn(static_cast<ShapeRule::Group>(group), shapes[shape])) {
        members_[group].push_back(shape);
      }
    }
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
