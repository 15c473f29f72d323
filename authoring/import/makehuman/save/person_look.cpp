// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/person_look.h"

#include "authoring/import/makehuman/save/macro_factors.h"

namespace furrow::authoring {

PersonLook LookOf(const MhmSave& save) {
  const MacroFactors factors = FactorsOf(MacroValuesOf(save));
  return {factors.Of("old"), factors.Of("asian"), factors.Of("african")};
}

}  // namespace furrow::authoring
