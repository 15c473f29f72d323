// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "character/character.h"
#include "gltf/scene/expression_rules.h"
#include "wrinkle/shapes/shape_rules.h"

namespace furrow::character {

// The rules of a file for the shapes that the character has. Of several for one shape, the first
// counts.
[[nodiscard]] std::vector<wrinkle::ShapeRule> MakeShapeRules(
    std::span<const gltf::ExpressionRule> from, std::span<const std::string> shapes);

// The character's rules as gltf::kRulesExtra.
[[nodiscard]] nlohmann::json ShapeRulesJson(const Character& character);

}  // namespace furrow::character
