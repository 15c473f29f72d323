// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"

namespace furrow::authoring {

// Appends an outer ear (helix, antihelix, concha, tragus, lobe) to the skin of the head. The ear is
// sunk slightly into the head. Its UV island is in the band below v = 0.87. `side`: +1 is the
// subject's left.
void AddEar(float side, int level, HeadMesh* head);

}  // namespace furrow::authoring
