// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Sets the skin weights of a head: skull and jaw, the neck below, and a soft influence around every
// muscle joint. Upper and lower lips (and lids) get different weights even where they touch. Each
// vertex has at most four joints, and its weights sum to 1. `skeleton`: that of MakeSkeleton().
void SkinHead(const wrinkle::Skeleton& skeleton, HeadMesh* head);

}  // namespace furrow::authoring
