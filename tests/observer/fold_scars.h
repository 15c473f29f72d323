// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

// Whether folds look like scars, as numbers. A scar is isolated, short, hard at its rims and runs
// against the folds around it.
namespace furrow::observer {

// One small patch of a folded surface at rest. Lengths in millimetres.
struct FoldPlace {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f, 0.0f, 1.0f};  // unit
  float area = 0.0f;                   // square millimetres, > 0
  float height = 0.0f;                 // above the surface without folds
  glm::vec3 slope{0.0f};               // gradient of the height; lies in the surface
  // The strongest compression of the surface, [0, 1], its direction (unit), and the compression
  // across that direction.
  float compression = 0.0f;
  glm::vec3 direction{1.0f, 0.0f, 0.0f};
  float crossing = 0.0f;
  bool drawn = false;  // a stroke of the artist asks for a fold here
};

// The folds of one region, at one place per texel.
struct FoldPatch {
  std::vector<FoldPlace> places;
  double wavelength = 5.0;  // the distance from valley to valley that the folds are meant to have
};

// What makes folds look like scars. All numbers are shares, [0, 1]; 0 without folds.
//
// - The share of a set of places counts each place with its area times its squared slope: steep
//   flanks are what light shows.
// - What a stroke draws is meant to be as it is: strokes run across the pull of a muscle, which the
//   strain of a few joints shows only roughly. Of the scars, it can only be a hard one.
// - against: folds that run within 45 degrees of the compression that makes them. Folds run across
//   it. 0.5 for folds in random directions. Only places count that are compressed by at least 6%
//   and half more than across.
// - drawn_against: the same of folds that a stroke draws. For information; the limit is 1.
// - disordered: folds whose directions agree by less than 0.6 within two wavelengths. The agreement
//   is |sum w e^(2 i a)| / sum w, with the direction a and the weight w of each place: 1 for
//   parallel folds, 0 for folds of all directions.
// - A furrow is a connected set of places that are deeper than 0.02 wavelengths: shallower ones do
//   not show. Its length is its extent. `isolated` and `short_deep` are shares of the length of all
//   furrows. A stroke draws a furrow if it draws at least half of its area.
// - isolated: shorter than four wavelengths, without another furrow within 1.5 wavelengths.
// - short_deep: shorter than two wavelengths, and deeper than 0.1.
// - hard: ridges with a radius below 1 mm, as a share of the area of all ridges. Skin is too thick
//   to fold more sharply outwards.
struct ScarMeasures {
  double against = 0.0;
  double drawn_against = 0.0;
  double disordered = 0.0;
  double isolated = 0.0;
  double short_deep = 0.0;
  double hard = 0.0;
};

// The most that folds may have of each without looking like scars.
inline constexpr ScarMeasures kScarLimits{.against = 0.25,
                                          .drawn_against = 1.0,
                                          .disordered = 0.45,
                                          .isolated = 0.1,
                                          .short_deep = 0.1,
                                          .hard = 0.1};

// True if no number of `measures` is above `limits`.
[[nodiscard]] bool IsWithin(const ScarMeasures& measures, const ScarMeasures& limits);

// Measures a patch. Places that face each other across a gap, such as closed lips, do not count as
// neighbours.
[[nodiscard]] ScarMeasures MeasureScars(const FoldPatch& patch);

}  // namespace furrow::observer
