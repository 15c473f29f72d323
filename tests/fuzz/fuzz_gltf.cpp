// SPDX-License-Identifier: Apache-2.0
// Characters in glTF: in every accepted file, all indices are in range and skin weights sum to 1.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "character/package/package.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::character;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto character = ParseCharacter(bytes, "no/such/folder");
  if (!character.ok()) return 0;
  const int joints = character->skeleton.num_joints();
  if (static_cast<int>(character->inverse_bind_matrices.size()) != joints) std::abort();
  for (const Mesh& mesh : character->meshes) {
    if (mesh.material >= static_cast<int>(character->materials.size())) std::abort();
    for (const std::uint32_t index : mesh.indices) {
      if (index >= mesh.vertices.size()) std::abort();
    }
    for (const Vertex& vertex : mesh.vertices) {
      float sum = 0.0f;
      for (int i = 0; i < 4; ++i) {
        if (vertex.joints[i] >= joints) std::abort();
        sum += vertex.skin_weights[i];
      }
      if (!(std::abs(sum - 1.0f) < 1e-3f)) std::abort();
    }
  }
  for (const Material& material : character->materials) {
    if (material.base_colour_texture >= static_cast<int>(character->pictures.size())) std::abort();
  }
  return 0;
}
