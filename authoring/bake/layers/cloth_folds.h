// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/layers/wrinkle_mesh.h"
#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// The folds that the poses of one wrinkle map press into cloth.
class ClothFolds {
 public:
  // `mesh` must outlive the folds. `ease`: how much longer cloth is than the surface at rest.
  // `depth`: multiplier for the heights.
  ClothFolds(const FineMesh& mesh, float ease, float depth, std::uint32_t seed)
      : mesh_(mesh), ease_(ease), depth_(depth), seed_(seed) {}

  // Adds a pose (BakePose::path, shape_weights and weight count). `mask`: where it counts, one per
  // welded vertex, [0, 1]. `wavelength`: from fold to fold where the pose deforms cloth, metres, >
  // 0. Where cloth hangs, it is wider, by HangingWidth(). Masks of one pose with one wavelength
  // are joined, so that its folds cross the borders of regions. `ease`: inside the mask; where
  // masks of one pose overlap, the loosest counts.
  void Add(const BakePose& pose, std::span<const float> mask, float wavelength,
           const ClothEase& ease = {});

  // Simulates all poses. Where several poses meet, the deepest folds of them prevail, in
  // proportion to mask times weight: the mean of folds at different places would be flat. The
  // result does not depend on `threads`. Returns false if `progress` cancels.
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
    std::vector<SkinMatrices> path;
    std::vector<float> shape_weights;
    std::vector<float> room;    // per vertex of the mesh: the mask
    std::vector<float> shares;  // the same, times the weight
    float wavelength = 0.0f;
    std::vector<ClothEase> eases;  // per vertex of the mesh
    std::vector<float> wider;      // per vertex of the mesh: multiplier for the wavelength
    std::vector<WrinkleMesh::Fold> folds;
  };
  // Calls `step` after every step of the path; it returns false to stop.
  template <class Step>
  void SolvePose(Pose* pose, const Step& step) const;
  [[nodiscard]] std::vector<glm::vec3> LastPlaces(const Pose& pose) const;
  [[nodiscard]] std::vector<float> WiderWhereHanging(std::span<const glm::vec3> cut,
                                                     std::span<const glm::vec3> bent,
                                                     std::span<const glm::mat3> slipped) const;
  [[nodiscard]] std::vector<float> Prominence(const Pose& pose) const;
  void Mix();
  template <class T>
  void Smooth(std::vector<T>* values, int passes) const;
  void MeasureCavities(const std::vector<float>& wavelengths);

  const FineMesh& mesh_;
  float ease_;
  float depth_;
  std::uint32_t seed_;
  std::vector<Pose> poses_;
  // Per vertex of the mesh.
  std::vector<float> heights_;
  std::vector<glm::vec3> gradients_;
  std::vector<float> cavities_;
};

}  // namespace furrow::authoring
