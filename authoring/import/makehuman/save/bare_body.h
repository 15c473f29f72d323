// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/rig/rig.h"

namespace furrow::authoring {

// Removes from a rig what only clothes show: wrinkle maps of the surface cloth, their feeds,
// regions without other feeds, and drivers that only those feeds used. A character without clothes
// needs no such maps, and baking them would fail.
void RemoveClothMaps(wrinkle::Rig* rig);

}  // namespace furrow::authoring
