// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"

namespace furrow::authoring {

// Appends an outer ear (helix, antihelix, concha, tragus, lobe) to the skin of the head. The ear is
// sunk slightly into the head. Its UV island is in the lowest band of the atlas, v in [0.87, 1].
// `side`: +1 the subject's left, -1 the right. `level`: level of detail, 0 coarsest to 2 finest.
void AddEar(float side, int level, HeadMesh* head);

}  // namespace furrow::authoring
