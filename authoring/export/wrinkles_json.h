// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "authoring/export/engine.h"
#include "authoring/export/export_pictures.h"
#include "authoring/export/export_plan.h"
#include "character/character.h"
#include "rig/exports/export_profile.h"

namespace furrow::authoring {

inline constexpr int kWrinklesVersion = 1;  // of wrinkles.json; readers refuse later ones

// What wrinkles.json says besides the plan.
struct WrinklesFile {
  Engine engine = Engine::kGeneric;
  NormalFormat normals;
  std::string generator;  // "furrow 0.1.0"
  std::span<const rig::ExportCoverage> names;
  // File names by what they hold: PictureKey() below and "shader.<material's name>".
  const std::map<std::string, std::string>* files = nullptr;
  // Millimetres of a full texel by the index of the map, for maps with a height file.
  const std::map<int, float>* height_mm = nullptr;
  // Scales of derivative maps by the key of their file, and their bits; 0: there are none.
  const std::map<std::string, float>* derivative_scales = nullptr;
  int derivative_bits = 0;
};

// The key of a file in WrinklesFile::files: "map.squash.normal", "mask.0", "material.skin.colour".
[[nodiscard]] std::string PictureKey(const std::string& kind, const std::string& name,
                                     const std::string& part = {});

// The text of wrinkles.json, which docs/ENGINES.md describes field by field.
[[nodiscard]] std::string WrinklesJson(const character::Character& character,
                                       const ExportPlan& plan, const WrinklesFile& file);

}  // namespace furrow::authoring
