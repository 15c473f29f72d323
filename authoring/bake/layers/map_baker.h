// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "authoring/bake/layers/blood.h"
#include "authoring/bake/layers/cloth_folds.h"
#include "authoring/bake/layers/fold_layer.h"
#include "authoring/bake/layers/profile.h"
#include "authoring/bake/layers/skin_grain.h"
#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/request/baked_maps.h"
#include "authoring/bake/surface/bake_surface.h"
#include "character/character.h"

namespace furrow::authoring {

// Bakes one wrinkle map of one surface: combines the strain of the poses, places strokes and folds,
// then fills the texels. Add all poses and strokes, then call Bake() once.
class MapBaker {
 public:
  // `map`: name of the map. `cloth`: `surface` is cloth, not skin. All references must outlive the
  // baker.
  MapBaker(const character::Character& character, const BakeSurface& surface,
           const BakeOptions& options, std::string map, bool cloth);

  // Adds the strain of a pose. `further`: see ClothFolds::Add().
  void AddPose(const BakePose& pose, const BakePose* further = nullptr);
  // Adds a stroke, which must outlive the baker.
  void AddStroke(const BakeStroke& stroke);

  // Reports progress from `from` to `to`, fractions of the whole bake in [0, 1]. Errors: those of
  // StrokeLayer::Create() and KernelSet::Create().
  [[nodiscard]] Result<std::unique_ptr<BakedMap>> Bake(float from, float to,
                                                       BakeProgress* progress);

 private:
  struct RegionFolds {
    std::string region;
    std::vector<float> compression;  // per welded vertex: the largest over the region's poses
  };

  [[nodiscard]] std::vector<float> MaskOf(const std::string& region) const;
  [[nodiscard]] std::vector<float> ClothMask(const std::string& region,
                                             std::vector<float> painted) const;
  [[nodiscard]] FabricFolds FabricOf(const std::string& region) const;
  [[nodiscard]] ClothEase EaseOf(const std::string& region) const;
  [[nodiscard]] float Depth() const { return options_.depth * material_.depth; }
  [[nodiscard]] std::vector<float> ByRegion(std::span<const std::pair<std::string, float>> values,
                                            float other) const;
  [[nodiscard]] std::vector<float> Wavelengths() const;
  // The shortest wavelength that the map's texels can show, per welded vertex, metres.
  [[nodiscard]] std::vector<float> Smallest() const;
  // Makes all folds but those of strokes.
  Status MakeLayers(const StrokeLayer& strokes, const std::vector<Tensor2>& tensors,
                    BakeProgress* progress);
  [[nodiscard]] FoldSample FoldsAt(const SurfacePoint& point, const glm::vec3& tangent,
                                   const glm::vec3& bitangent, const StrokeLayer& strokes) const;
  // The folds at a texel, with the grain of the skin.
  [[nodiscard]] FoldSample TexelFold(const SurfaceTexel& texel, const StrokeLayer& strokes) const;
  bool FillTexels(const StrokeLayer& strokes, BakeProgress* progress, BakedMap* map) const;
  void AddBlood(BakedMap* map) const;
  void Measure(const std::vector<float>& compression, const StrokeLayer& strokes,
               BakedMap* map) const;
  void MeasureWavelengths(BakedMap* map) const;
  [[nodiscard]] BakedMask SuggestMask(const RegionFolds& folds) const;

  const character::Character& character_;
  const BakeSurface& surface_;
  const BakeOptions& options_;
  const BakeMaterial& material_;
  std::string map_;
  bool cloth_;
  FoldProfile profile_;
  SkinGrain grain_;
  CompressionSum sum_;
  BloodSum blood_;
  float worst_ = 0.0f;
  std::vector<const BakeStroke*> strokes_;
  std::vector<RegionFolds> regions_;
  std::vector<std::unique_ptr<FoldLayer>> layers_;  // of skin
  std::unique_ptr<ClothFolds> cloth_folds_;         // of cloth
};

}  // namespace furrow::authoring
