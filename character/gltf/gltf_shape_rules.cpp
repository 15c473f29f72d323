// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_shape_rules.h"

#include <algorithm>

#include "base/ascii.h"

namespace furrow::character {

using wrinkle::ShapeRule;

static_assert(gltf::kOverrideNames.size() == ShapeRule::kNumGroups);

namespace {

// ShapeRule::kNoShape: there is no shape of this name.
std::uint32_t FindShape(std::span<const std::string> shapes, const std::string& name) {
  const auto found = std::ranges::find_if(
      shapes, [&](const std::string& shape) { return EqualsIgnoreCase(shape, name); });
  return found == shapes.end() ? ShapeRule::kNoShape
                               : static_cast<std::uint32_t>(found - shapes.begin());
}

}  // namespace

std::vector<ShapeRule> MakeShapeRules(std::span<const gltf::ExpressionRule> from,
                                      std::span<const std::string> shapes) {
  std::vector<ShapeRule> rules;
  for (const gltf::ExpressionRule& rule : from) {
    const std::uint32_t index = FindShape(shapes, rule.shape);
    if (index == ShapeRule::kNoShape) continue;
    if (std::ranges::find(rules, index, &ShapeRule::shape) != rules.end()) continue;
    ShapeRule& to = rules.emplace_back();
    to.shape = index;
    to.is_binary = rule.is_binary;
    if (rule.gaze) to.gaze = {.input = rule.gaze->input, .output = rule.gaze->output};
    to.contains = FindShape(shapes, rule.contains);
    // The values of both enumerations have the order of gltf::kOverrideValues.
    for (std::size_t i = 0; i < to.limits.size(); ++i) {
      to.limits[i] = static_cast<ShapeRule::Limits>(rule.overrides[i]);
    }
  }
  return rules;
}

nlohmann::json ShapeRulesJson(const Character& character) {
  nlohmann::json list = nlohmann::json::array();
  for (const ShapeRule& rule : character.shape_rules) {
    if (rule.shape >= character.shapes.size()) continue;
    nlohmann::json entry = {{"shape", character.shapes[rule.shape]}};
    if (rule.is_binary) entry["isBinary"] = true;
    for (std::size_t i = 0; i < rule.limits.size(); ++i) {
      if (rule.limits[i] == ShapeRule::Limits::kNothing) continue;
      entry[gltf::kOverrideNames[i]] =
          gltf::kOverrideValues[static_cast<std::size_t>(rule.limits[i])];
    }
    if (rule.gaze) {
      entry["gaze"] = {{"inputMaxValue", rule.gaze->input}, {"outputScale", rule.gaze->output}};
    }
    if (rule.contains < character.shapes.size()) {
      entry["contains"] = character.shapes[rule.contains];
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace furrow::character
