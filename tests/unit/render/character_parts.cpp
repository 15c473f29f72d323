// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/character_parts.h"

#include <cstdlib>
#include <iostream>

namespace furrow::render::test {

void AddGrid(std::uint32_t columns, std::uint32_t rows,
             const std::function<character::Vertex(float u, float v)>& vertex,
             character::Mesh* mesh) {
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      mesh->vertices.push_back(vertex(static_cast<float>(column) / static_cast<float>(columns),
                                      static_cast<float>(row) / static_cast<float>(rows)));
    }
  }
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = first + row * (columns + 1) + column;
      const std::uint32_t b = a + columns + 1;
      mesh->indices.insert(mesh->indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
}

wrinkle::JointDesc Joint(const std::string& name, int parent, const glm::vec3& translation) {
  wrinkle::JointDesc joint;
  joint.name = name;
  joint.parent = parent;
  joint.rest.translation = translation;
  return joint;
}

void SetSkeleton(std::vector<wrinkle::JointDesc> joints, character::Character* character) {
  auto skeleton = wrinkle::Skeleton::Create(std::move(joints));
  if (!skeleton.ok()) {
    std::cerr << skeleton.status().ToString() << std::endl;
    std::abort();
  }
  character->skeleton = std::move(*skeleton);
  character->inverse_bind_matrices.clear();
  for (const glm::mat4& rest : character->skeleton.rest_model()) {
    character->inverse_bind_matrices.push_back(glm::inverse(rest));
  }
}

}  // namespace furrow::render::test
