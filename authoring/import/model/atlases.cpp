// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/atlases.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/uv_check.h"

namespace furrow::authoring {
namespace {

using character::Character;
using character::Material;

float AreaOf(const Character& character, int material) {
  float area = 0.0f;
  for (const character::Mesh& mesh : character.meshes) {
    if (mesh.material != material) continue;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const glm::vec3& a = mesh.vertices[mesh.indices[i]].position;
      area += glm::length(glm::cross(mesh.vertices[mesh.indices[i + 1]].position - a,
                                     mesh.vertices[mesh.indices[i + 2]].position - a));
    }
  }
  return area;
}

std::vector<int> MeshesOf(const Character& character, std::span<const int> materials) {
  std::vector<int> meshes;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const int material = character.meshes[m].material;
    if (std::find(materials.begin(), materials.end(), material) != materials.end()) {
      meshes.push_back(static_cast<int>(m));
    }
  }
  return meshes;
}

// Samples that both cover are counted once in the union.
bool Overlap(const Character& character, std::span<const int> chosen, int candidate) {
  constexpr int kSamples = 256;  // per side
  std::vector<int> both(chosen.begin(), chosen.end());
  both.push_back(candidate);
  const auto covered = [&](std::span<const int> materials) {
    return CheckUvs(character, MeshesOf(character, materials), kSamples).covered;
  };
  const float candidate_alone = covered(std::span(&candidate, 1));
  const float shared = covered(chosen) + candidate_alone - covered(both);
  return shared > kTolerableUvOverlap * std::max(candidate_alone, 0.01f);
}

// The materials of skin or cloth that have wrinkles, the largest first; `first` before all.
std::vector<int> MaterialsOn(const Character& character, bool cloth, int first) {
  std::set<int> materials;
  for (const int mesh : MeshesOn(character, cloth)) {
    const int material = character.meshes[static_cast<std::size_t>(mesh)].material;
    if (material >= 0) materials.insert(material);
  }
  std::vector<std::pair<float, int>> order;
  for (const int material : materials) {
    order.emplace_back(material == first ? -1e30f : -AreaOf(character, material), material);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> sorted;
  for (const auto& [area, material] : order) sorted.push_back(material);
  return sorted;
}

// A square of the atlas.
struct Tile {
  glm::vec2 corner{0.0f};
  float side = 1.0f;
};

// The smallest box around a material's UVs; the unit square if they lie in it, so that islands keep
// their places.
struct UvBox {
  glm::vec2 low{0.0f};
  glm::vec2 size{1.0f};
};

UvBox BoxOf(const Character& character, int material) {
  glm::vec2 low(0.0f), high(1.0f);
  for (const character::Mesh& mesh : character.meshes) {
    if (mesh.material != material) continue;
    for (const character::Vertex& vertex : mesh.vertices) {
      low = glm::min(low, vertex.uv);
      high = glm::max(high, vertex.uv);
    }
  }
  return {low, high - low};
}

void MoveToTile(int material, const Tile& tile, Character* character) {
  const UvBox box = BoxOf(*character, material);
  const glm::vec2 scale = tile.side / box.size;
  for (character::Mesh& mesh : character->meshes) {
    if (mesh.material != material) continue;
    for (character::Vertex& vertex : mesh.vertices) {
      vertex.uv = tile.corner + (vertex.uv - box.low) * scale;
    }
  }
  Material& moved = character->materials[static_cast<std::size_t>(material)];
  // Composed with a transform that the material had before.
  moved.texture_offset += moved.texture_scale * (box.low - tile.corner / scale);
  moved.texture_scale /= scale;
}

}  // namespace

std::vector<std::string> ChooseAtlases(int first, Character* character) {
  std::vector<std::string> without;
  for (const bool cloth : {false, true}) {
    std::vector<int> chosen;
    for (const int material : MaterialsOn(*character, cloth, first)) {
      if (chosen.empty() || !Overlap(*character, chosen, material)) {
        chosen.push_back(material);
        continue;
      }
      Material& other = character->materials[static_cast<std::size_t>(material)];
      other.wrinkles = false;
      without.push_back(other.name);
    }
  }
  return without;
}

std::vector<std::string> TileClothAtlas(Character* character) {
  const std::vector<int> materials = MaterialsOn(*character, true, -1);
  bool overlap = false;
  for (std::size_t i = 1; i < materials.size(); ++i) {
    overlap = overlap || Overlap(*character, std::span(materials).first(i), materials[i]);
  }
  if (!overlap) return {};
  constexpr float kMargin = 0.01f;  // of a tile's side, against filters that reach over the edge
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(materials.size()))));
  const float side = 1.0f / static_cast<float>(columns);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const glm::vec2 place(static_cast<int>(i) % columns, static_cast<int>(i) / columns);
    MoveToTile(materials[i], {side * (place + kMargin), side * (1.0f - 2.0f * kMargin)}, character);
    names.push_back(character->materials[static_cast<std::size_t>(materials[i])].name);
  }
  return names;
}

}  // namespace furrow::authoring
