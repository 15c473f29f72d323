// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace furrow::wrinkle {

// How a shape limits others while it acts, and whether it knows only on and off.
struct ShapeRule {
  // kBlock: any weight above 0 stops the others. kBlend: they fade as it rises.
  enum class Limits : std::uint8_t { kNothing, kBlock, kBlend };
  // The shapes that rules limit: VRM's presets of these names.
  enum Group : std::uint8_t { kBlinks, kLooks, kVisemes, kNumGroups };

  std::uint32_t shape = 0;
  bool is_binary = false;  // its weight is 1 above 0.5, else 0
  std::array<Limits, kNumGroups> limits{};
};

// The rules of a character's shapes, applied to the weights of each pose. Source: VRMC_vrm-1.0,
// "Expressions": with w, the weights of the shapes that limit a group, its shapes are multiplied by
// max(0, 1 - sum of w), where kBlock counts as 1. A binary shape of the group that is limited at
// all is 0.
class ShapeRules {
 public:
  ShapeRules() = default;  // no rules
  // `shapes`: all names; matched without case. Rules of shapes that do not exist are ignored.
  ShapeRules(std::span<const ShapeRule> rules, std::span<const std::string> shapes);

  [[nodiscard]] bool empty() const { return rules_.empty(); }
  // `weights`: one per shape. Does not allocate.
  void Apply(std::span<float> weights) const;

 private:
  std::vector<ShapeRule> rules_;
  std::array<std::vector<std::uint32_t>, ShapeRule::kNumGroups> members_;  // shapes
  std::vector<bool> is_binary_;                                            // by shape
};

}  // namespace furrow::wrinkle
