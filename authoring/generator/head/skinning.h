// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Sets the skin weights of the head: skull and jaw, the neck below, and a soft influence around
// every muscle. `HeadVertex` separates the lips and the lids. At most four joints per vertex; the
// weights sum to 1.
void SkinHead(const wrinkle::Skeleton& skeleton, HeadMesh* head);

}  // namespace furrow::authoring
