// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace furrow::wrinkle {

// A rule of a shape of a face, besides how it moves vertices.
struct ShapeRule {
  // How the shape limits others while it acts. kBlock: any weight above 0 stops the others. kBlend:
  // they fade as it rises.
  enum class Limits : std::uint8_t { kNothing, kBlock, kBlend };
  // The shapes that rules limit. A shape belongs to at most one group, by its meaning; see
  // rig::ShapeMeanings.
  enum Group : std::uint8_t { kBlinks, kLooks, kMouths, kNumGroups, kNoGroup = kNumGroups };
  // How an eye that looks by shapes follows a gaze: a gaze of `input` degrees or more gives the
  // weight `output`, a smaller one its share.
  struct Gaze {
    float input = 90.0f;
    float output = 1.0f;
  };
  static constexpr std::uint32_t kNoShape = 0xffffffffu;

  std::uint32_t shape = 0;
  bool is_binary = false;  // its weight is 1 above 0.5, else 0
  std::array<Limits, kNumGroups> limits{};
  std::optional<Gaze> gaze = std::nullopt;
  // The shape that this one does as well: a mouthClose that opens the jaw to close the lips on it.
  std::uint32_t contains = kNoShape;
};

// The limits and the binary shapes among the rules of a character's shapes, applied to the weights
// of each pose. (Formulas have the rest: rig::ShapeMatcher::MatchFace().) Source: VRMC_vrm-1.0,
// "Expressions": with w, the weights of the shapes that limit a group, its shapes are multiplied by
// max(0, 1 - sum of w), where kBlock counts as 1. A binary shape of the group that is limited at
// all is 0. A shape does not limit its own group, because it would stop itself.
class ShapeRules {
 public:
  ShapeRules() = default;  // no rules
  // `groups`: of each shape. Rules of shapes that do not exist are ignored.
  ShapeRules(std::span<const ShapeRule> rules, std::span<const ShapeRule::Group> groups);

  [[nodiscard]] bool empty() const { return rules_.empty(); }
  // `weights`: one per shape. Does not allocate.
  void Apply(std::span<float> weights) const;

 private:
  std::vector<ShapeRule> rules_;
  std::array<std::vector<std::uint32_t>, ShapeRule::kNumGroups> members_;  // shapes
  std::vector<bool> is_binary_;                                            // by shape
};

}  // namespace furrow::wrinkle
