// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/atlases.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <glm/common.hpp>
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

// A part of the atlas.
struct Tile {
  glm::vec2 corner{0.0f};
  glm::vec2 size{1.0f};
};

// The smallest box around a material's UVs; a square of the grid of whole numbers if they lie in
// one, so that islands keep their places.
struct UvBox {
  glm::vec2 low{0.0f};
  glm::vec2 size{1.0f};
};

UvBox BoxOf(const Character& character, int material) {
  constexpr float kEdge = 0.01f;  // islands that reach this far over an edge are not beyond it
  glm::vec2 low(1e30f), high(-1e30f);
  for (const character::Mesh& mesh : character.meshes) {
    if (mesh.material != material) continue;
    for (const character::Vertex& vertex : mesh.vertices) {
      low = glm::min(low, vertex.uv);
      high = glm::max(high, vertex.uv);
    }
  }
  if (!(low.x <= high.x && low.y <= high.y)) return {};
  const glm::vec2 square = glm::floor(low + kEdge);
  low = glm::min(low, square);
  return {low, glm::max(high, square + 1.0f) - low};
}

// Materials whose UVs do not overlap share a tile. The material `first` is in the first group.
std::vector<std::vector<int>> GroupsOf(const Character& character, std::span<const int> materials) {
  std::vector<std::vector<int>> groups;
  for (const int material : materials) {
    // Only boxes of one size are scaled alike.
    const bool is_square = BoxOf(character, material).size == glm::vec2(1.0f);
    const auto fits = [&](const std::vector<int>& group) {
      return is_square && BoxOf(character, group.front()).size == glm::vec2(1.0f) &&
             !Overlap(character, group, material);
    };
    const auto group = std::find_if(groups.begin(), groups.end(), fits);
    if (group == groups.end()) {
      groups.push_back({material});
    } else {
      group->push_back(material);
    }
  }
  return groups;
}

// Equal squares.
std::vector<Tile> EqualTiles(std::size_t count) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const float side = 1.0f / static_cast<float>(columns);
  std::vector<Tile> tiles;
  for (std::size_t i = 0; i < count; ++i) {
    tiles.push_back({side * glm::vec2(i % columns, i / columns), glm::vec2(side)});
  }
  return tiles;
}

// The first tile is the left 60% of the atlas, and the others share the rest. Few tiles are stacked
// in one column, more in several.
std::vector<Tile> TilesBesideTheFirst(std::size_t count) {
  constexpr float kFirst = 0.6f;
  constexpr std::size_t kRows = 4;
  std::vector<Tile> tiles = {{glm::vec2(0.0f), {kFirst, 1.0f}}};
  const std::size_t others = count - 1;
  const std::size_t columns = (others + kRows - 1) / kRows;
  const std::size_t rows = (others + columns - 1) / columns;
  const glm::vec2 size((1.0f - kFirst) / static_cast<float>(columns),
                       1.0f / static_cast<float>(rows));
  for (std::size_t i = 0; i < others; ++i) {
    tiles.push_back({glm::vec2(kFirst, 0.0f) + size * glm::vec2(i / rows, i % rows), size});
  }
  return tiles;
}

void MoveToTile(int material, const Tile& tile, Character* character) {
  const UvBox box = BoxOf(*character, material);
  const glm::vec2 scale = tile.size / box.size;
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

std::vector<AtlasTile> TileAtlas(bool cloth, int first, Character* character) {
  const std::vector<int> materials = MaterialsOn(*character, cloth, first);
  const std::vector<std::vector<int>> groups = GroupsOf(*character, materials);
  if (groups.size() < 2) return {};
  constexpr float kMargin = 0.01f;  // of a tile's side, against filters that reach over the edge
  const bool has_first = first >= 0 && groups.front().front() == first;
  std::vector<Tile> tiles =
      has_first ? TilesBesideTheFirst(groups.size()) : EqualTiles(groups.size());
  std::vector<AtlasTile> named;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Tile& tile = tiles[i];
    const float share = tile.size.x * tile.size.y;
    tile.corner += kMargin * tile.size;
    tile.size *= 1.0f - 2.0f * kMargin;
    AtlasTile& entry = named.emplace_back(AtlasTile{{}, share});
    for (const int material : groups[i]) {
      MoveToTile(material, tile, character);
      entry.materials.push_back(character->materials[static_cast<std::size_t>(material)].name);
    }
  }
  return named;
}

std::string DescribeTiles(const std::vector<AtlasTile>& tiles, bool cloth) {
  std::string text = std::string("UVs of the ") + (cloth ? "cloth" : "skin") +
                     " overlap, so its materials share the texels of the wrinkle maps: ";
  for (const AtlasTile& tile : tiles) {
    if (&tile != &tiles.front()) text += ", ";
    for (const std::string& name : tile.materials) {
      text += (&name == &tile.materials.front() ? "'" : " and '") + name + "'";
    }
    text += " " + std::to_string(std::lround(100.0f * tile.share)) + " %";
  }
  return text + "; --texture-size, or --size of 'furrow bake', gives them more";
}

}  // namespace furrow::authoring
