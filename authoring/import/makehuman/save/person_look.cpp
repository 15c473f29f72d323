// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/person_look.h"

#include <algorithm>
#include <string>

#include "authoring/import/makehuman/save/macro_factors.h"
#include "base/ascii.h"

namespace furrow::authoring {

PersonLook LookOf(const MhmSave& save) {
  const MacroFactors factors = FactorsOf(MacroValuesOf(save));
  PersonLook look{factors.Of("old"), factors.Of("asian"), factors.Of("african")};
  const std::string skin = AsciiLower(save.skin_material);
  const auto names = [&skin](const char* word) { return skin.find(word) != std::string::npos; };
  const bool asian = names("asian") && !names("caucasian");
  if (asian || names("african") || names("caucasian")) {
    look.asian = asian ? 1.0f : 0.0f;
    look.african = names("african") ? 1.0f : 0.0f;
  }
  if (names("old_")) look.old = std::max(look.old, 0.8f);
  if (names("middleage")) look.old = std::max(look.old, 0.3f);
  return look;
}

}  // namespace furrow::authoring
