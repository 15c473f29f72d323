// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "character/character.h"
#include "rig/shapes/shape_match.h"
#include "wrinkle/shapes/shape_program.h"

namespace furrow::authoring {

// What ARKit's 52 blend shapes do to a character, whatever its own shapes are called: the shapes
// that the daemon moves when a stream sends them. A rig's blend-shape drivers may add names of
// their own.
//
// Shapes that belong to several parts of the face count as missing: VRM's "joy" lifts the corners
// of the mouth and squints, so where it moves skin shows neither a mouth nor an eye. The parts are
// brows, eyes with the upper cheeks, and the rest.
class ArkitFace {
 public:
  using Coefficient = std::pair<std::string, float>;  // name, value

  ArkitFace() = default;  // a character without shapes
  // `matcher`: the shape maps; without maps, shapes match by equal names only.
  ArkitFace(const character::Character& character, const rig::ShapeMatcher& matcher);

  // True if the blend shape `name` (any case) alone moves a vertex.
  [[nodiscard]] bool Has(std::string_view name) const;
  // The weight of each of Character::shapes for the given coefficients; others are 0. Unknown names
  // count as 0.
  [[nodiscard]] std::vector<float> Weights(std::span<const Coefficient> coefficients) const;
  // The same as the face is drawn, with its limits and rules (rig::ShapeMatcher::MatchFace()).
  [[nodiscard]] std::vector<float> DrawnWeights(std::span<const Coefficient> coefficients) const;
  // The weights for one blend shape at 1.
  [[nodiscard]] std::vector<float> Weights(std::string_view name) const;

  // rig::Describe() of the match: empty if all shapes have ARKit's names.
  [[nodiscard]] const std::string& description() const { return description_; }

 private:
  [[nodiscard]] std::vector<float> Run(const wrinkle::ShapeProgram& program,
                                       std::span<const Coefficient> coefficients) const;

  std::unordered_map<std::string, std::size_t> names_;  // lowercase, to coefficient
  wrinkle::ShapeProgram program_;
  wrinkle::ShapeProgram drawn_;
  std::vector<bool> usable_;  // per shape: moves vertices of one part of the face
  std::string description_;
};

// The blend shapes that the character lacks and without which a face is not recognised:
// browInnerUp, and browDown, eyeBlink and mouthSmile of both sides.
[[nodiscard]] std::vector<std::string> MissingOfShapeFace(const ArkitFace& face);
// True if it lacks none.
[[nodiscard]] bool HasShapeFace(const ArkitFace& face);

}  // namespace furrow::authoring
