// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "character/character.h"
#include "gltf/scene/material_binds.h"

namespace furrow::character {

// The binds of a file. Adds the names of expressions that change materials and move no vertex to
// `shapes`. Returns the names for which kMaxShapes left no place; their binds are left out.
std::vector<std::string> MakeMaterialBinds(std::span<const gltf::MaterialBind> from,
                                           std::vector<std::string>* shapes,
                                           std::vector<MaterialBind>* binds);

// The character's binds as gltf::kMaterialBindsExtra.
[[nodiscard]] nlohmann::json MaterialBindsJson(const Character& character);

}  // namespace furrow::character
