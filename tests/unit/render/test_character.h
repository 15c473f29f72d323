// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/character.h"
#include "wrinkle/solver/solver.h"

// Small characters made by formula, so that what they should look like is known.
namespace furrow::render::test {

// Test set-up cannot go on without its value.
template <class T>
T Expect(Result<T> result) {
  if (!result.ok()) {
    std::cerr << result.status().ToString() << std::endl;
    std::abort();
  }
  return std::move(result).value();
}

// A 16-bit RGBA picture of a function of (u, v in [0, 1], v down) with values in [0, 1].
[[nodiscard]] character::Picture MakePicture(
    const std::string& name, int size, const std::function<glm::vec4(float, float)>& function);

// A normal map of a height field: u and v in [0, 1], heights in units of the texture's width.
[[nodiscard]] character::Picture NormalMapOf(const std::string& name, int size,
                                             const std::function<float(float, float)>& height);

// An egg-shaped head of 0.24 m around (0, 1.6, 0), facing +Z, with its seam at the back.
//
// Joints: root, head (at the egg's centre, the anchor) and brow (above the front). Rig, in the
// order of its weights: region "left" (texture mask, red: the subject's left half) with the maps
// stretch and squash, fed by the blend shapes l_stretch and l_squash; "right" (green) likewise;
// region "brow" (skinning) with the map folds, fed by the hinge at the joint brow.
[[nodiscard]] character::Character MakeHead();

// A square of 2 x 2 m in the plane z = 0, facing +Z, one joint; u along +X, v along -Y. One
// material of kind skin with the base normal map `base`; texture mask 1 everywhere in the red
// channel; one wrinkle map a height field of `wrinkles`, each with a region r0, r1, ... fed by the
// blend shape of that name.
[[nodiscard]] character::Character MakePlane(
    int map_size, const std::function<float(float, float)>& base,
    const std::vector<std::function<float(float, float)>>& wrinkles);

// A subject of the character at rest with named weights: what a FrameRequest needs.
struct Subject {
  explicit Subject(const character::Character& character);
  void Set(const std::string& blend_shape, float value);  // then Solve()
  void Solve();

  wrinkle::RigBinding binding;
  wrinkle::LocalPose pose;
  std::vector<std::string> blend_shapes;
  std::vector<glm::mat4> model;
  std::vector<float> driver_values;
  std::vector<float> weights;
};

}  // namespace furrow::render::test
