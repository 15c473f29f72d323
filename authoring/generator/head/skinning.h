// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "character/character.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Skin weights of the head: the skull and the jaw, the neck below, and over them a soft field about
// every muscle; lips and lids are told apart by `info`. At most four a vertex, summing to 1.
void SkinHead(const wrinkle::Skeleton& skeleton, HeadMesh* head);

}  // namespace furrow::authoring
