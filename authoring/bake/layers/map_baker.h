// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"
#include "authoring/bake/layers/blood.h"
#include "authoring/bake/layers/fold_layer.h"
#include "authoring/bake/layers/profile.h"
#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/pace.h"
#include "authoring/bake/surface/bake_surface.h"

namespace furrow::character::bake {

// Bakes one map onto a surface: strain of its poses, strokes, folds, texels.
class MapBaker {
 public:
  // All are kept by reference.
  MapBaker(const Character& character, const BakeSurface& surface, const BakeOptions& options,
           std::string map, bool cloth);

  void AddPose(const BakePose& pose);
  void AddStroke(const BakeStroke& stroke);

  // From `from` to `to` of the whole. Errors: StrokeLayer's, KernelSet's.
  [[nodiscard]] Result<std::unique_ptr<BakedMap>> Bake(float from, float to, Pace* pace);

 private:
  struct RegionFolds {
    std::string region;
    std::vector<float> compression;  // one a welded vertex, the strongest of its poses
  };

  [[nodiscard]] std::vector<float> MaskOf(const std::string& region) const;
  [[nodiscard]] float Depth() const { return options_.depth * material_.depth; }
  [[nodiscard]] std::vector<float> Wavelengths() const;
  // Metres; what the map's texels can show, one a welded vertex.
  [[nodiscard]] std::vector<float> Smallest() const;
  Status MakeLayers(const FoldField& field, Pace* pace);
  [[nodiscard]] FoldSample FoldsAt(const SurfacePoint& point, const glm::vec3& tangent,
                                   const glm::vec3& bitangent, const StrokeLayer& strokes) const;
  bool FillTexels(const StrokeLayer& strokes, Pace* pace, BakedMap* map) const;
  void FillBlood(BakedMap* map) const;
  void Measure(const std::vector<float>& compression, const StrokeLayer& strokes,
               BakedMap* map) const;
  void MeasureWavelengths(BakedMap* map) const;
  [[nodiscard]] BakedMask SuggestMask(const RegionFolds& folds) const;

  const Character& character_;
  const BakeSurface& surface_;
  const BakeOptions& options_;
  const BakeMaterial& material_;
  std::string map_;
  bool cloth_;
  FoldProfile profile_;
  CompressionSum sum_;
  BloodSum blood_;
  float worst_ = 0.0f;
  std::vector<const BakeStroke*> strokes_;
  std::vector<RegionFolds> regions_;
  std::vector<std::unique_ptr<FoldLayer>> layers_;
};

}  // namespace furrow::character::bake
