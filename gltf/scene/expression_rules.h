// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/vrm_look_at.h"

namespace furrow::gltf {

// `extras` of a package's first scene: an array of rules, as an object each with the members
// "shape", "isBinary", "overrideBlink", "overrideLookAt", "overrideMouth", "gaze" (an object with
// "inputMaxValue" and "outputScale") and "contains" (the name of another shape).
inline constexpr char kRulesExtra[] = "furrow_shape_rules";

// What an expression of VRM does besides moving vertices.
struct ExpressionRule {
  enum class Override : std::uint8_t { kNothing, kBlock, kBlend };
  std::string shape;                    // the name of the expression
  bool is_binary = false;               // it knows only 0 and 1
  std::array<Override, 3> overrides{};  // of blinking, looking and the mouth
  // Of a look, if the avatar looks by expressions: a gaze of `input` degrees (0 to 180) gives
  // the weight `output` (0 to 1).
  std::optional<VrmLookAt::Range> gaze = std::nullopt;
  std::string contains = {};  // a shape that this one does as well (kRulesExtra only)
  [[nodiscard]] bool does_nothing() const {
    return !is_binary && overrides == std::array<Override, 3>{} && !gaze && contains.empty();
  }
};

// The names of the overrides in VRM and in kRulesExtra, and of an override's values.
inline constexpr std::array<const char*, 3> kOverrideNames = {"overrideBlink", "overrideLookAt",
                                                              "overrideMouth"};
inline constexpr std::array<const char*, 3> kOverrideValues = {"none", "block", "blend"};

// Reads the rules of VRM 0.x (isBinary and gazes) and 1.0, or of kRulesExtra, that do something.
// Members of an unexpected type count as missing. At most kMaxVrmNodes rules; more are ignored with
// a warning.
[[nodiscard]] std::vector<ExpressionRule> ReadExpressionRules(Document* document);

}  // namespace furrow::gltf
