// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_mesh.h"

#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

std::uint32_t AddHeadVertex(HeadMesh* head, const HeadVertex& info, const glm::vec2& uv) {
  character::Vertex vertex;
  vertex.position = HeadToModel(info.place);
  vertex.uv = uv;
  head->mesh.vertices.push_back(vertex);
  head->info.push_back(info);
  return static_cast<std::uint32_t>(head->mesh.vertices.size() - 1);
}

}  // namespace furrow::authoring
