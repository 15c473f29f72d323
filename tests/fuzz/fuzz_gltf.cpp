// SPDX-License-Identifier: Apache-2.0
// Characters in glTF: in every accepted file, all indices are in range, skin weights sum to 1, and
// morph targets ascend by shape and vertex.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "character/package/package.h"

namespace {

using furrow::character::Mesh;
using furrow::character::MorphDelta;
using furrow::character::MorphTarget;

void CheckMorphTargets(const Mesh& mesh, std::size_t num_shapes) {
  int last_shape = -1;
  for (const MorphTarget& target : mesh.morph_targets) {
    if (target.shape <= last_shape || target.deltas.empty()) std::abort();
    last_shape = target.shape;
    std::size_t next = 0;
    for (const MorphDelta& delta : target.deltas) {
      if (delta.vertex < next || delta.vertex >= mesh.vertices.size()) std::abort();
      next = std::size_t{delta.vertex} + 1;
    }
  }
  if (last_shape >= static_cast<int>(num_shapes)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::character;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto character = ParseCharacter(bytes, "no/such/folder");
  if (!character.ok()) return 0;
  const int joints = character->skeleton.num_joints();
  if (static_cast<int>(character->inverse_bind_matrices.size()) != joints) std::abort();
  if (character->shapes.size() > kMaxShapes) std::abort();
  for (const Mesh& mesh : character->meshes) {
    CheckMorphTargets(mesh, character->shapes.size());
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
  for (const MaterialBind& bind : character->material_binds) {
    if (bind.shape >= character->shapes.size()) std::abort();
    if (bind.material >= character->materials.size()) std::abort();
    if (!(std::abs(bind.emission.x) <= 1e3f) || !(std::abs(bind.uv_scale.x) <= 1e5f)) std::abort();
  }
  for (const Material& material : character->materials) {
    if (material.base_colour_texture >= static_cast<int>(character->pictures.size())) std::abort();
  }
  return 0;
}
