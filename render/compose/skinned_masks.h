// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "character/character.h"
#include "render/compose/compose_job.h"
#include "render/wrinkles/dynamic_masks.h"
#include "render/wrinkles/mask_regions.h"
#include "render/wrinkles/uv_raster.h"

namespace furrow::render {

// The masks by skin weights of one material, as they lie in its textures.
//
// - What a vertex takes of a joint's influence, lambda of its skin weight, is the same in every
//   pose. So each joint that may raise a map is a channel, as one of a mask texture; the sum of
//   channels times influences is what fragments interpolate between vertices.
// - Beyond the edges of the surface a texel has what its nearest point has, as far as filtering
//   reaches.
// - A texture cannot tell places apart that share a texel, as two sleeves with one texture do.
// - So many masks that finding them would hold up the picture count as that, too.
class SkinnedMasks {
 public:
  // `meshes`: all of the material; not kept. `shares`: what joints may raise there.
  SkinnedMasks(std::span<const character::Mesh> meshes, std::span<const SkinnedShare> shares,
               std::span<const glm::mat4> inverse_bind_matrices, int material);

  // Of `shares`, those that some vertex takes anything of; is_unique().
  [[nodiscard]] std::span<const SkinnedShare> channels() const { return channels_; }
  // One each of channels().
  [[nodiscard]] std::span<const MaskRegion> regions() const { return regions_; }
  // No two places of the surface that share a texel have different masks. Where they have, there
  // are neither channels() nor regions().
  [[nodiscard]] bool is_unique() const { return is_unique_; }

  // Adds to the tiles of a level, row after row, what lies in them; is_unique(). Channel 0 is
  // `first_channel` there.
  void AddTo(glm::ivec2 size, std::size_t first_channel, std::vector<ComposeTile>* tiles) const;

 private:
  // What a vertex takes of a channel.
  struct Part {
    std::uint32_t channel = 0;
    float lambda = 0.0f;
  };
  // The place of the surface that a texel shows.
  struct Place {
    std::int32_t triangle = -1;  // -1: none
    float away_squared = 0.0f;
    glm::vec3 shares{0.0f};
  };
  // Of all vertices; false: too many.
  [[nodiscard]] bool AddParts(std::span<const character::Mesh> meshes,
                              std::span<const SkinnedShare> shares);
  void AddTriangles(const character::Mesh& mesh);
  // Leaves out the shares that nobody takes anything of.
  void FindChannels(std::span<const SkinnedShare> shares);
  void FindRegions(std::span<const character::Mesh> meshes,
                   std::span<const glm::mat4> inverse_bind_matrices, int material);
  [[nodiscard]] bool IsFlat(std::size_t triangle, std::vector<float>* apart) const;
  [[nodiscard]] bool FindUnique() const;
  [[nodiscard]] std::span<const Part> PartsOf(std::uint32_t vertex) const;
  [[nodiscard]] bool IsMasked(std::size_t triangle) const;
  // Whether two places have the same masks, to what a byte tells. `apart`: zeros, one each of
  // channels(), before and after.
  [[nodiscard]] bool IsAlike(const Place& a, const Place& b, std::vector<float>* apart) const;
  // Adds a place's masks to `values`, one each of channels(), times `factor`.
  void AddValues(const Place& place, float factor, std::vector<float>* values) const;
  [[nodiscard]] std::vector<Place> Places(glm::ivec2 size) const;
  void FillTile(const std::vector<Place>& places, glm::ivec2 size, std::size_t first_channel,
                ComposeTile* tile) const;

  std::vector<SkinnedShare> channels_;
  std::vector<MaskRegion> regions_;
  std::vector<UvTriangle> triangles_;
  std::vector<std::uint32_t> corners_;      // three a triangle: vertices of all meshes
  std::vector<Part> parts_;                 // vertex after vertex
  std::vector<std::uint32_t> first_parts_;  // where each vertex's begin, and the end
  bool is_unique_ = false;
};

}  // namespace furrow::render
