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

// Small procedural characters with a known appearance.
namespace furrow::render::test {

// Aborts if the value is missing, because test set-up cannot continue without it.
template <class T>
T Expect(Result<T> result) {
  if (!result.ok()) {
    std::cerr << result.status().ToString() << std::endl;
    std::abort();
  }
  return std::move(result).value();
}

// A 16-bit RGBA picture of a function of (u, v), both in [0, 1] with v down, and values in [0, 1].
[[nodiscard]] character::Picture MakePicture(
    const std::string& name, int size, const std::function<glm::vec4(float, float)>& function);

// The normal map of a height field: u and v in [0, 1], heights in units of the texture's width.
[[nodiscard]] character::Picture NormalMapOf(const std::string& name, int size,
                                             const std::function<float(float, float)>& height);

// An egg-shaped head of 0.24 m around (0, 1.6, 0) that faces +Z, with the seam at the back.
//
// Joints: root, head (the anchor, at the egg's centre) and brow (above the front). Rig, in the
// order of its weights: region "left" (texture mask, red: the subject's left half) with the maps
// stretch and squash, driven by the blend shapes l_stretch and l_squash; region "right" (green),
// likewise; region "brow" (skinning mask) with the map folds, driven by a hinge at the joint brow.
[[nodiscard]] character::Character MakeHead();

// A square of 2 x 2 m in the plane z = 0 that faces +Z, with one joint; u along +X, v along -Y. One
// material of kind skin with the base normal map `base`. The texture mask is 1 everywhere in the
// red channel. Each height field of `wrinkles` becomes a wrinkle map with a region r0, r1, ...,
// driven by the blend shape of that name.
[[nodiscard]] character::Character MakePlane(
    int map_size, const std::function<float(float, float)>& base,
    const std::vector<std::function<float(float, float)>>& wrinkles);

// MakePlane() without maps, of columns x rows quads. `adjust` may change each vertex; optional.
[[nodiscard]] character::Character MakeSheet(
    std::uint32_t columns, std::uint32_t rows,
    const std::function<void(character::Vertex*)>& adjust = {});

// A subject of the character at rest with named weights, in the form that a FrameRequest needs.
struct Subject {
  explicit Subject(const character::Character& character);
  void Set(const std::string& blend_shape, float value);  // call Solve() afterwards
  void Solve();

  wrinkle::RigBinding binding;
  wrinkle::LocalPose pose;
  std::vector<std::string> blend_shapes;
  std::vector<glm::mat4> model;
  std::vector<float> driver_values;
  std::vector<float> weights;
};

}  // namespace furrow::render::test
