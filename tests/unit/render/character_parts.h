// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "character/character.h"

// What characters made by formula have in common.
namespace furrow::render::test {

// Adds a sheet of `columns` x `rows` quads, facing out where v runs down and u to the right:
// `vertex` of every (u, v), both in [0, 1].
void AddGrid(std::uint32_t columns, std::uint32_t rows,
             const std::function<character::Vertex(float u, float v)>& vertex,
             character::Mesh* mesh);

// Gives the character these joints, bound in their rest pose. Aborts where they are no skeleton.
void SetSkeleton(std::vector<wrinkle::JointDesc> joints, character::Character* character);

}  // namespace furrow::render::test
