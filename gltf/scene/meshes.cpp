// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/meshes.h"

#include <utility>

#include <tiny_gltf.h>

namespace furrow::gltf {

Result<std::vector<Mesh>> ReadMeshes(const Document& document) {
  const tinygltf::Model& model = document.model();
  std::vector<Mesh> meshes;
  for (const tinygltf::Mesh& from : model.meshes) {
    const std::string index = std::to_string(meshes.size());
    Mesh& mesh = meshes.emplace_back();
    mesh.name = from.name.empty() ? "mesh_" + index : from.name;
    for (const tinygltf::Primitive& part : from.primitives) {
      if (part.material < kNone || part.material >= static_cast<int>(model.materials.size())) {
        return Status(StatusCode::kSchema,
                      "material " + std::to_string(part.material) + " does not exist",
                      "meshes[" + index + "].primitives[" + std::to_string(mesh.primitives.size()) +
                          "].material");
      }
      mesh.primitives.push_back({part.mode == TINYGLTF_MODE_TRIANGLES, part.attributes,
                                 part.indices, part.material, part.targets.size()});
    }
  }
  return meshes;
}

}  // namespace furrow::gltf
