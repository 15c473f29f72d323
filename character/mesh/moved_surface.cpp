// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/moved_surface.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace furrow::character {

wrinkle::MovedSurface FindMovedSurface(std::span<const Mesh> meshes) {
  wrinkle::MovedSurface surface;
  for (const Mesh& mesh : meshes) {
    std::vector<wrinkle::MovedSurface::Point> points(mesh.vertices.size());
    for (const MorphTarget& target : mesh.morph_targets) {
      for (const MorphDelta& delta : target.deltas) {
        points[delta.vertex].deltas.push_back(
            {static_cast<std::uint32_t>(target.shape), delta.position});
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].deltas.empty()) continue;
      points[i].position = mesh.vertices[i].position;
      surface.points.push_back(std::move(points[i]));
    }
  }
  return surface;
}

}  // namespace furrow::character
