// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/mask_regions.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "render/mesh/uv_density.h"
#include "render/wrinkles/derivative_map.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {
namespace {

// The texels where one channel of a mask is above 0, as a summed-area table for queries by
// rectangle.
class Coverage {
 public:
  Coverage(const character::Picture& mask, int channel)
      : size_(mask.width, mask.height),
        sums_(static_cast<std::size_t>(mask.width + 1) *
              static_cast<std::size_t>(mask.height + 1)) {
    for (int y = 0; y < size_.y; ++y) {
      std::uint32_t row = 0;  // the sum of this row so far
      for (int x = 0; x < size_.x; ++x) {
        row += Texel(mask, x, y, channel) > 0.0f ? 1 : 0;
        Sum(x + 1, y + 1) = row + Sum(x + 1, y);
      }
    }
  }

  // Returns true if a filtered look-up in the rectangle may return more than 0. UV beyond [0, 1]
  // repeats.
  [[nodiscard]] bool Touches(const glm::vec2& low, const glm::vec2& high) {
    // Moves the rectangle by whole repeats into [0, 1], and grows it by a texel, because filtering
    // reads neighbours.
    const glm::vec2 turn = glm::floor(low);
    const glm::ivec2 first(glm::floor((low - turn) * glm::vec2(size_)) - 1.0f);
    const glm::ivec2 last(glm::floor((high - turn) * glm::vec2(size_)) + 2.0f);
    if (first.x < 0 || first.y < 0 || last.x > size_.x || last.y > size_.y) {
      return Sum(size_.x, size_.y) > 0;  // wraps around: use a coarse answer
    }
    return Sum(last.x, last.y) + Sum(first.x, first.y) >
           Sum(first.x, last.y) + Sum(last.x, first.y);
  }

 private:
  // The sum of all texels to the left of x and above y.
  std::uint32_t& Sum(int x, int y) {
    return sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x + 1) +
                 static_cast<std::size_t>(x)];
  }

  glm::ivec2 size_;
  std::vector<std::uint32_t> sums_;
};

// Appends the triangles of a mesh where the mask may be above 0. Each gets its own vertices.
void AddPart(const character::Mesh& mesh, Coverage* coverage, character::Mesh* part) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto corners = std::span(mesh.indices).subspan(i, 3);
    glm::vec2 low = mesh.vertices[corners[0]].uv;
    glm::vec2 high = low;
    for (const std::uint32_t corner : corners) {
      low = glm::min(low, mesh.vertices[corner].uv);
      high = glm::max(high, mesh.vertices[corner].uv);
    }
    if (!coverage->Touches(low, high)) continue;
    for (const std::uint32_t corner : corners) {
      part->indices.push_back(static_cast<std::uint32_t>(part->vertices.size()));
      part->vertices.push_back(mesh.vertices[corner]);
    }
  }
}

}  // namespace

void AddMaskRegions(const character::Character& character, const character::Picture& mask,
                    int layer, std::vector<MaskRegion>* regions) {
  for (int channel = 0; channel < 4; ++channel) {
    Coverage coverage(mask, channel);
    for (int material = 0; material < static_cast<int>(character.materials.size()); ++material) {
      const auto& surface = character.materials[static_cast<std::size_t>(material)];
      if (GroupOf(character, surface) == WrinkleGroup::kNone) continue;
      character::Mesh part;
      for (const character::Mesh& mesh : character.meshes) {
        if (mesh.material == material) AddPart(mesh, &coverage, &part);
      }
      if (part.indices.empty()) continue;
      regions->push_back({4 * layer + channel, material,
                          JointBounds(part, character.inverse_bind_matrices), MinUvPerMetre(part)});
    }
  }
}

}  // namespace furrow::render
