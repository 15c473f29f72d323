// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "character/character.h"

// Shared parts of procedural characters.
namespace furrow::render::test {

// Adds a sheet of `columns` x `rows` quads. `vertex` gives the vertex at (u, v), both in [0, 1].
// The sheet faces the viewer if v runs down and u to the right.
void AddGrid(std::uint32_t columns, std::uint32_t rows,
             const std::function<character::Vertex(float u, float v)>& vertex,
             character::Mesh* mesh);

// A joint at `translation` from its parent (index `parent`; -1: a root), without a rotation.
[[nodiscard]] wrinkle::JointDesc Joint(const std::string& name, int parent,
                                       const glm::vec3& translation);
// Gives the character these joints, bound in their rest pose. Aborts if they do not form a
// skeleton.
void SetSkeleton(std::vector<wrinkle::JointDesc> joints, character::Character* character);

}  // namespace furrow::render::test
