// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"
#include "authoring/bake/layers/compression.h"
#include "authoring/bake/pace.h"
#include "authoring/bake/surface/surface.h"
#include "authoring/paint/uv_raster.h"

namespace furrow::character::bake {

// Everything about the skin or the clothes of a character that several maps share.
class BakeSurface {
 public:
  // kInvalidArgument: nothing of the kind, no UVs, no triangle of extent. kUnavailable: stopped.
  [[nodiscard]] static Result<std::unique_ptr<BakeSurface>> Create(const Character& character,
                                                                   bool cloth,
                                                                   const BakeOptions& options,
                                                                   Pace* pace);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const CompressionSolver& solver() const { return solver_; }
  [[nodiscard]] const std::vector<paint::Texel>& texels() const { return texels_; }
  [[nodiscard]] std::int64_t overlaps() const { return overlaps_; }
  // Side of a texel on the surface, metres, one a welded vertex: a face takes more of its picture
  // than a back.
  [[nodiscard]] std::span<const float> texel_metres() const { return texel_metres_; }

  // A region's mask at the welded vertices, [0, 1]; empty where it has no picture: everywhere all.
  [[nodiscard]] std::vector<float> MaskOf(const Character& character,
                                          const wrinkle::Region& region) const;

 private:
  BakeSurface(std::span<const Mesh* const> meshes, float smoothing, int size, Pace* pace);
  [[nodiscard]] std::vector<float> TexelSides(int size) const;

  Surface surface_;
  CompressionSolver solver_;
  std::int64_t overlaps_ = 0;
  std::vector<paint::Texel> texels_;
  std::vector<float> texel_metres_;
};

// The meshes that make up the skin or the clothes: indices into Character::meshes.
[[nodiscard]] std::vector<int> MeshesOn(const Character& character, bool cloth);

// Whether a map goes on cloth; see Bake().
[[nodiscard]] bool GoesOnCloth(const Character& character, const wrinkle::WrinkleMap& map);

}  // namespace furrow::character::bake
