// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/cloth/cloth_effect.h"
#include "authoring/bake/cloth/crease_lines.h"
#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// The folds that the poses of one wrinkle map press into cloth.
//
// - Each pose gives the excess of every place: the share of its length that cloth must hide, and
//   the direction of it. It is the length that the pose takes from the surface
//   (MeasureClothStrain()), the ease of the cloth, what cloth is too wide across a pull, and what
//   stacks on something below (MeasureClothEffect()).
// - The poses are joined to one field, in which creases are laid (LayCreases()): large forms where
//   a pose deforms the cloth, folds of the fabric's wavelength, and in sharp bends small ones and
//   diamonds.
// - The creases are drawn as crests (DrawCreases()).
class ClothFolds {
 public:
  // `mesh`: where strain is measured and creases are laid. `drawn`: where their relief is drawn, at
  // least as fine. Both are of one surface and must outlive the folds. `ease`: how much longer
  // cloth is than the surface at rest. `depth`: multiplier for the heights.
  ClothFolds(const FineMesh& mesh, const FineMesh& drawn, float ease, float depth,
             std::uint32_t seed)
      : mesh_(mesh), drawn_(drawn), ease_(ease), depth_(depth), seed_(seed) {}

  // Adds a pose: the ends of BakePose::path, shape_weights and weight count. `mask`: where it
  // counts, one per welded vertex, [0, 1]. Masks of one pose with one fabric are joined, so that
  // its folds cross the borders of regions. `ease`: inside the mask; where masks of one pose
  // overlap, the loosest counts. `further`: a pose that goes on where this one ends, or null.
  // Creases are laid for that one, so that both poses have the same creases at other depths.
  void Add(const BakePose& pose, std::span<const float> mask, const FabricFolds& fabric,
           const ClothEase& ease = {}, const BakePose* further = nullptr);

  // Measures all poses and draws their folds. Where several poses meet, the strongest excess
  // prevails. The result does not depend on `threads`. Returns false if `progress` cancels.
  [[nodiscard]] bool Solve(int threads, BakeProgress* progress);

  // The folds at a point, after Solve(). `tangent`, `bitangent`: unit vectors along which the slope
  // is measured. Thread-safe.
  [[nodiscard]] FoldSample At(const SurfacePoint& point, const glm::vec3& tangent,
                              const glm::vec3& bitangent) const;

  // The shortest and the longest wavelength of all poses, metres; 0 without poses.
  [[nodiscard]] std::pair<float, float> Wavelengths() const;

 private:
  using SkinMatrices = std::vector<glm::mat4>;  // one per joint of the skeleton
  struct Pose {
    WornCloth cloth;
    SkinMatrices bent;
    SkinMatrices further;  // empty: none
    std::vector<float> shape_weights;
    std::vector<float> shares;  // the mask times the weight, per vertex of the mesh
    ClothEffect own;
    ClothEffect laid;  // of `further` if there is one, else empty
  };
  // A size of creases.
  struct Size;

  void Join();
  void Steer();
  void Add(const Size& size);
  [[nodiscard]] bool Draw(BakeProgress* progress);
  void LimitSlopes();
  void RoundFolds();
  void MeasureCavities();

  const FineMesh& mesh_;
  const FineMesh& drawn_;
  float ease_;
  float depth_;
  std::uint32_t seed_;
  std::vector<Pose> poses_;
  // Per welded vertex of the surface: the largest of all poses.
  std::vector<float> mask_;
  std::vector<float> radii_;  // FabricFolds::radius, fading out with the mask, metres
  // Per vertex of the mesh, by Join().
  std::vector<glm::vec3> normals_;
  CreaseField field_;          // for which creases are laid
  std::vector<float> excess_;  // for which they are drawn
  std::vector<float> pressed_;
  std::vector<float> merged_;  // how much wider apart creases are that merge, in their spacings
  std::vector<float> deep_;    // multiplier for the heights
  // Per vertex of the drawn mesh.
  std::vector<float> heights_;  // metres
  std::vector<glm::vec3> gradients_;
  std::vector<float> cavities_;
};

}  // namespace furrow::authoring
