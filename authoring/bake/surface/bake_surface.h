// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/surface/compression.h"
#include "authoring/bake/surface/fine_mesh.h"
#include "authoring/bake/surface/surface.h"
#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// The point of a surface at the centre of a texel.
[[nodiscard]] inline SurfacePoint PlaceOf(const SurfaceTexel& texel) {
  return {texel.triangle, texel.corners, texel.position};
}

// The skin or the clothes of a character, with the data that all maps of this surface share.
class BakeSurface {
 public:
  // `cloth`: true for the clothes, false for the skin. Errors: kInvalidArgument (the character has
  // no such mesh, or the mesh has no UVs or no triangle with an area), kUnavailable (cancelled).
  [[nodiscard]] static Result<std::unique_ptr<BakeSurface>> Create(
      const character::Character& character, bool cloth, const BakeOptions& options,
      BakeProgress* progress);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const CompressionSolver& solver() const { return solver_; }
  // Cloth only, else null: the mesh on which its strain is measured and its creases are laid.
  [[nodiscard]] const FineMesh* fine_mesh() const { return fine_mesh_.get(); }
  // Cloth only, else null: the mesh on which their relief is drawn, with edges half as long.
  [[nodiscard]] const FineMesh* relief_mesh() const { return relief_mesh_.get(); }
  // The texels that the surface covers.
  [[nodiscard]] const std::vector<SurfaceTexel>& texels() const { return texels_; }
  // The number of texels inside several triangles.
  [[nodiscard]] std::int64_t overlaps() const { return overlaps_; }
  // The length of a texel's side on the surface, metres, one per welded vertex. It varies because
  // UV islands have different scales.
  [[nodiscard]] std::span<const float> texel_metres() const { return texel_metres_; }

  // A region's mask at the welded vertices, [0, 1]. Empty if the region has no texture mask, which
  // means 1 everywhere.
  [[nodiscard]] std::vector<float> MaskOf(const character::Character& character,
                                          const wrinkle::Region& region) const;

 private:
  BakeSurface(std::span<const character::Mesh* const> meshes, float smoothing, int size,
              BakeProgress* progress);
  [[nodiscard]] std::vector<float> TexelSides(int size) const;
  [[nodiscard]] float ClothEdge() const;

  Surface surface_;
  CompressionSolver solver_;
  std::unique_ptr<FineMesh> fine_mesh_;
  std::unique_ptr<FineMesh> relief_mesh_;
  std::int64_t overlaps_ = 0;
  std::vector<SurfaceTexel> texels_;
  std::vector<float> texel_metres_;
};

// The meshes of the skin or the clothes, as indices into Character::meshes.
[[nodiscard]] std::vector<int> MeshesOn(const character::Character& character, bool cloth);

// True if a map is drawn on cloth: the rig names cloth, or it allows any surface and the character
// has cloth but no skin.
[[nodiscard]] bool GoesOnCloth(const character::Character& character,
                               const wrinkle::WrinkleMap& map);
// True if the map of a feed is drawn on cloth; false if the rig lacks the map.
[[nodiscard]] bool FoldsCloth(const character::Character& character, const wrinkle::Feed& feed);

}  // namespace furrow::authoring
