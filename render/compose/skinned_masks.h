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

// One material's masks by skin weight, rasterized into the space of its textures.
//
// - The share of a joint's influence that a vertex takes (lambda of its skin weight) does not
// depend
//   on the pose. Each (joint, map) pair is therefore a channel, like a channel of a mask texture.
//   The wrinkle weight at a point is the sum of its channels, each times the joint's influence.
// - A texel beyond the edge of the surface gets the value of its nearest point, as far as filtering
//   reaches.
// - A texture cannot distinguish points that share a texel, for example those of two sleeves with
//   one texture. Such materials are not composed; see is_unique().
// - Materials with too many masks are not composed either, because rasterizing them would delay the
//   picture.
class SkinnedMasks {
 public:
  // `meshes`: all meshes of the material `material`. `shares`: the (joint, map) pairs that can be
  // above 0 in some pose. The arguments are only used during construction.
  SkinnedMasks(std::span<const character::Mesh> meshes, std::span<const SkinnedShare> shares,
               std::span<const glm::mat4> inverse_bind_matrices, int material);

  // The members of `shares` that affect at least one vertex. Requires is_unique().
  [[nodiscard]] std::span<const SkinnedShare> channels() const { return channels_; }
  // The part of the surface where each channel is above 0; one per channel.
  [[nodiscard]] std::span<const MaskRegion> regions() const { return regions_; }
  // False if two points of the surface share a texel and have different masks. channels() and
  // regions() are then empty.
  [[nodiscard]] bool is_unique() const { return is_unique_; }

  // Adds the masks to ComposeTile::skinned of all tiles of a level of `size` texels. The first of
  // channels() gets the channel number `first_channel`. Requires is_unique().
  void AddTo(glm::ivec2 size, std::size_t first_channel, std::vector<ComposeTile>* tiles) const;

 private:
  // The share of a channel that a vertex takes.
  struct Part {
    std::uint32_t channel = 0;
    float lambda = 0.0f;
  };
  // The point of the surface that a texel shows.
  struct Place {
    std::int32_t triangle = -1;  // -1: none
    float distance_squared = 0.0f;
    glm::vec3 shares{0.0f};
  };
  // Collects the parts of all vertices. False: too many.
  [[nodiscard]] bool AddParts(std::span<const character::Mesh> meshes,
                              std::span<const SkinnedShare> shares);
  void AddTriangles(const character::Mesh& mesh);
  // Drops the shares that affect no vertex.
  void FindChannels(std::span<const SkinnedShare> shares);
  void FindRegions(std::span<const character::Mesh> meshes,
                   std::span<const glm::mat4> inverse_bind_matrices, int material);
  [[nodiscard]] bool IsFlat(std::size_t triangle, std::vector<float>* difference) const;
  [[nodiscard]] bool FindUnique() const;
  [[nodiscard]] std::span<const Part> PartsOf(std::uint32_t vertex) const;
  [[nodiscard]] bool IsMasked(std::size_t triangle) const;
  // Returns true if the masks of two points differ by less than a byte can show. `difference`:
  // scratch memory, zeros before and after, one per channel.
  [[nodiscard]] bool IsAlike(const Place& a, const Place& b, std::vector<float>* difference) const;
  // Adds the masks of a point, times `factor`, to `values`, one per channel.
  void AddValues(const Place& place, float factor, std::vector<float>* values) const;
  [[nodiscard]] std::vector<Place> Places(glm::ivec2 size) const;
  void FillTile(const std::vector<Place>& places, glm::ivec2 size, std::size_t first_channel,
                ComposeTile* tile) const;

  std::vector<SkinnedShare> channels_;
  std::vector<MaskRegion> regions_;
  std::vector<UvTriangle> triangles_;
  std::vector<std::uint32_t> corners_;      // three per triangle: vertex indices over all meshes
  std::vector<Part> parts_;                 // vertex by vertex
  std::vector<std::uint32_t> first_parts_;  // start of each vertex's parts, and the end
  bool is_unique_ = false;
};

}  // namespace furrow::render
