// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/import/makehuman/formats/mhm.h"

namespace furrow::authoring {

// What of a person decides the painted skin and hair. The shares are in [0, 1] and follow from the
// save, also where the folder has no targets for them.
struct PersonLook {
  float old = 0.0f;    // 0 up to 25 years, 1 at 90
  float asian = 0.0f;  // with `african` and the rest, caucasian, 1
  float african = 0.0f;
};

// The look of the person in `save`. The name of its skin counts more than its macro values, since
// many people have a skin such as "old_african_female" and average macro values.
[[nodiscard]] PersonLook LookOf(const MhmSave& save);

}  // namespace furrow::authoring
